// SPDX-License-Identifier: Apache-2.0
#include "material/assets/compose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "core/base/files.h"
#include "core/base/parallel.h"
#include "core/image_io/image_io.h"
#include "core/solve/solve_record.h"
#include "core/solve/verdict.h"
#include "material/assets/build.h"
#include "material/assets/material_preview.h"
#include "material/assets/stack.h"
#include "material/filtering/joined_gloss.h"
#include "material/filtering/roughness_mips.h"
#include "material/layers/lay.h"
#include "material/run/map_facts.h"
#include "material/run/surface_files.h"
#include "solve/files/pictures.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;
using enum Parameter;

// How a parameter is written where it is a map.
struct WrittenMap {
  Parameter parameter;
  const char* name;
  std::vector<std::string> channels;
  const char* unit;
};

const std::vector<WrittenMap>& plain_maps() {
  static const std::vector<WrittenMap> maps = {{kHeight, "height", {"height"}, "mm"},
                                               {kOcclusion, "occlusion", {"openness"}, "share"},
                                               {kCavity, "cavity", {"cavity"}, ""},
                                               {kSpecularTint, "specular_tint", {"R", "G", "B"}, "share"},
                                               {kMetallic, "metallic", {"metallic"}, "share"},
                                               {kSheenRoughness, "sheen_roughness", {"sheen_roughness"}, ""}};
  return maps;
}

Image<float> filled_map(const ParameterField& field, Size size) {
  if (field.is_map()) return std::move(copy_of(field).map);
  Image<float> map(size, field.planes);
  for (int p = 0; p < field.planes; ++p) {
    for (int y = 0; y < size.height; ++y)
      std::fill_n(map.plane(p).row(y), size.width,
                  static_cast<float>(field.constant[static_cast<std::size_t>(p)]));
  }
  return map;
}

class Composer {
 public:
  Composer(const MaterialNode& node, MaterialStack stack, fs::path folder, const ComposeOptions& options,
           const JobContext& context)
      : node_(node),
        stack_(std::move(stack)),
        folder_(std::move(folder)),
        options_(options),
        context_(context) {
    surface_.mm_per_pixel = node.mm_per_pixel();
    surface_.is_tile = node.is_tile;
  }

  Result<Json> run() {
    const std::vector<Result<void> (Composer::*)()> steps = {
        &Composer::write_normal, &Composer::write_plain,   &Composer::write_opacity,
        &Composer::write_lobe,   &Composer::write_fuzz,    &Composer::write_albedo,
        &Composer::write_mips,   &Composer::write_weights, &Composer::draw};
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (context_.stop.stop_requested()) return interrupted();
      context_.progress("compose", static_cast<double>(i) / static_cast<double>(steps.size()));
      if (Result<void> ok = (this->*steps[i])(); !ok) return std::move(ok).error();
    }
    return document();
  }

 private:
  Result<void> write(MapFacts facts, const Image<float>& map) {
    facts.file = facts.name + ".exr";
    const std::vector<View<const float>> planes = planes_of(map);
    measure(facts, planes.front());
    const double mm = node_.is_size_known ? surface_.mm_per_pixel : 0;
    const WriteOptions options = {.type = SampleType::kFloat,
                                  .compression = options_.compression,
                                  .attributes = attributes_of(facts, mm),
                                  .pitch_mm = {mm, mm},
                                  .color = facts.name == "albedo" || facts.name == "sheen"
                                               ? ColorSpace::kLinearColor
                                               : ColorSpace::kData};
    Result<void> ok = write_image(folder_ / facts.file, planes, facts.channels, options);
    maps_.push_back(json_of(facts));
    return ok;
  }

  void note_parameter(Parameter parameter, const ParameterField& field) {
    const ParameterFacts& facts = facts_of(parameter);
    const int count = numbers_of(facts.kind);
    Json value = count == 1 ? Json(field.constant[0]) : Json(field.constant);
    parameters_[facts.name] = {{"value", std::move(value)}, {"source", stack_.source(parameter)}};
  }

  Result<void> write_normal() {
    Result<ParameterField> slopes = stack_.composed(kNormal);
    if (!slopes) return std::move(slopes).error();
    has_relief_ = slopes->is_map();
    surface_.slope = filled_map(*slopes, node_.size);
    surface_.status = Image<std::uint16_t>(node_.size);
    return write(
        {.name = "normal", .channels = {"X", "Y", "Z"}, .source = map_source_named(stack_.source(kNormal))},
        normals_of(surface_.slope));
  }

  Result<void> write_plain() {
    for (const WrittenMap& map : plain_maps()) {
      Result<ParameterField> field = stack_.composed(map.parameter);
      if (!field) return std::move(field).error();
      if (!field->is_map()) {
        note_parameter(map.parameter, *field);
        if (map.parameter == kSpecularTint) point_.f0_tint = field->constant;
        if (map.parameter == kSheenRoughness) point_.sheen_alpha = field->constant[0] * field->constant[0];
        if (map.parameter == kMetallic) point_.metallic = field->constant[0];
        continue;
      }
      const std::array<double, 3> mean = means_of(*field);
      if (map.parameter == kSpecularTint) point_.f0_tint = mean;
      if (map.parameter == kSheenRoughness) point_.sheen_alpha = mean[0] * mean[0];
      if (map.parameter == kMetallic) point_.metallic = mean[0];
      Result<void> ok = write({.name = map.name,
                               .unit = map.unit,
                               .channels = map.channels,
                               .source = map_source_named(stack_.source(map.parameter))},
                              field->map);
      if (!ok) return ok;
    }
    return {};
  }

  Result<void> write_opacity() {
    Result<ParameterField> field = stack_.composed(kOpacity);
    if (!field) return std::move(field).error();
    if (!field->is_map()) {
      note_parameter(kOpacity, *field);
      return {};
    }
    Result<void> ok = write({.name = "opacity",
                             .unit = "share",
                             .channels = {"opacity"},
                             .source = map_source_named(stack_.source(kOpacity))},
                            field->map);
    surface_.opacity = std::move(field->map);
    return ok;
  }

  // A yarn's two widths stand in one file, which a set of maps has too.
  Result<void> write_lobe() {
    Result<ParameterField> roughness = stack_.composed(kRoughness);
    if (!roughness) return std::move(roughness).error();
    Result<ParameterField> axis = stack_.composed(kAnisotropy);
    if (!axis) return std::move(axis).error();
    Result<ParameterField> specular = stack_.composed(kSpecular);
    if (!specular) return std::move(specular).error();
    const bool is_round = !axis->is_map() && axis->constant[0] == 0 && axis->constant[1] == 0;
    const std::string source = stack_.source(kRoughness);
    MapFacts facts = {.name = "roughness",
                      .channels = {"roughness", "alpha", "alpha_along", "yarn_deg"},
                      .source = map_source_named(source)};
    facts.more = {{"scale", name_of(GlossScale::kRoughness)}};
    if (is_round) note_parameter(kAnisotropy, *axis);
    if (is_round && !roughness->is_map()) {
      note_parameter(kRoughness, *roughness);
      alpha_ = roughness->constant[0] * roughness->constant[0];
      facts.constant = roughness->constant[0];
      facts.channels.clear();
      facts.why = "the same everywhere";
      facts.more["alpha"] = facts.more["alpha_along"] = alpha_;
      maps_.push_back(json_of(facts));
    } else {
      surface_.lobe = lobe_of(*roughness, *axis);
      if (Result<void> ok = write(std::move(facts), roughness_file(surface_.lobe)); !ok) return ok;
    }
    return write_specular(*specular);
  }

  Image<float> lobe_of(const ParameterField& roughness, const ParameterField& axis) const {
    Image<float> lobe(node_.size, 4);
    parallel_for(static_cast<std::size_t>(node_.size.height), context_.threads, [&](std::size_t row, int) {
      const int y = static_cast<int>(row);
      for (int x = 0; x < node_.size.width; ++x) {
        const double across = roughness.at(x, y) * roughness.at(x, y);
        const YarnAxis yarn = axis_from(axis.at(x, y, 0), axis.at(x, y, 1));
        lobe(x, y, 0) = static_cast<float>(across);
        lobe(x, y, 1) = static_cast<float>(across * (1 - yarn.anisotropy));
        lobe(x, y, 2) = static_cast<float>(yarn.azimuth_deg);
        lobe(x, y, 3) = static_cast<float>(point_.f0);
      }
    });
    return lobe;
  }

  static Image<float> roughness_file(const Image<float>& lobe) {
    Image<float> file(lobe.size(), 4);
    for (int y = 0; y < lobe.height(); ++y) {
      for (int x = 0; x < lobe.width(); ++x) {
        file(x, y, 0) =
            static_cast<float>(std::sqrt(std::sqrt(double{lobe(x, y, 0)} * double{lobe(x, y, 1)})));
        for (int p = 0; p < 3; ++p) file(x, y, p + 1) = lobe(x, y, p);
      }
    }
    return file;
  }

  Result<void> write_specular(ParameterField& specular) {
    multiply(specular, {kF0OfSpecular, 1, 1}, context_.threads);
    point_.f0 = means_of(specular)[0];
    MapFacts facts = {.name = "specular",
                      .unit = "share",
                      .channels = {"f0"},
                      .source = map_source_named(stack_.source(kSpecular))};
    if (specular.is_map()) return write(std::move(facts), specular.map);
    facts.constant = specular.constant[0];
    facts.channels.clear();
    facts.why = "the same everywhere";
    maps_.push_back(json_of(facts));
    parameters_["f0"] = {{"value", specular.constant[0]}, {"source", stack_.source(kSpecular)}};
    multiply(specular, {1 / kF0OfSpecular, 1, 1}, 1);
    note_parameter(kSpecular, specular);
    return {};
  }

  // Fibres that stand up: their weight, and their colour where they have any weight.
  Result<void> write_fuzz() {
    Result<ParameterField> cloth = stack_.composed(kCloth);
    if (!cloth) return std::move(cloth).error();
    Result<ParameterField> sheen = stack_.composed(kSheen);
    if (!sheen) return std::move(sheen).error();
    point_.cloth = means_of(*cloth)[0];
    point_.sheen = means_of(*sheen);
    const bool is_used = cloth->is_map() || cloth->constant[0] > 0;
    if (!cloth->is_map()) note_parameter(kCloth, *cloth);
    if (!sheen->is_map()) note_parameter(kSheen, *sheen);
    if (cloth->is_map()) {
      Result<void> ok = write({.name = "cloth",
                               .unit = "share",
                               .channels = {"cloth"},
                               .source = map_source_named(stack_.source(kCloth))},
                              cloth->map);
      if (!ok) return ok;
    }
    if (!is_used && !sheen->is_map()) return {};
    return write({.name = "sheen",
                  .unit = "share",
                  .channels = {"R", "G", "B"},
                  .source = map_source_named(stack_.source(kSheen))},
                 filled_map(*sheen, node_.size));
  }

  Result<void> write_albedo() {
    Result<ParameterField> albedo = stack_.composed(kAlbedo);
    if (!albedo) return std::move(albedo).error();
    if (!albedo->is_map()) note_parameter(kAlbedo, *albedo);
    surface_.albedo = filled_map(*albedo, node_.size);
    std::int64_t above = 0;
    for (int p = 0; p < 3; ++p) {
      for (int y = 0; y < node_.size.height; ++y) {
        const float* row = surface_.albedo.plane(p).row(y);
        above += std::count_if(row, row + node_.size.width, [](float v) { return v > 1; });
      }
    }
    if (above > 0) {
      verdicts_.push_back(
          {"ALBEDO_ABOVE_ONE",
           fmt::format("{:.3g} percent of the albedo's numbers are above 1, more than falls on the cloth",
                       100.0 * static_cast<double>(above) / (3.0 * static_cast<double>(node_.size.pixels()))),
           "darken albedo_tint, the tint of a layer, or the albedo"});
    }
    return write({.name = "albedo",
                  .unit = "share",
                  .channels = {"R", "G", "B"},
                  .source = map_source_named(stack_.source(kAlbedo))},
                 surface_.albedo);
  }

  // Mips come of what was composed, never of composed mips: only so do they have the spread of all normals
  // beneath.
  Result<void> write_mips() {
    if (!has_relief_ && surface_.lobe.empty()) return {};
    Result<std::vector<MipLevel>> levels =
        roughness_mips(surface_, {.alpha = alpha_, .threads = context_.threads});
    if (!levels) return std::move(levels).error();
    const fs::path folder = folder_ / "mips";
    if (Result<void> ok = make_writable_folder(folder); !ok) return ok;
    Json listed = Json::array();
    for (const MipLevel& level : *levels) {
      const std::string number = fmt::format("{:02}", level.level);
      const WriteOptions as_float = {.compression = options_.compression},
                         as_half = {.type = SampleType::kHalf, .compression = options_.compression};
      if (Result<void> ok = write_image(folder / ("normal_" + number + ".exr"), planes_of(level.normal),
                                        {"X", "Y", "Z"}, as_float);
          !ok)
        return ok;
      if (Result<void> ok = write_image(folder / ("lobe_" + number + ".exr"), planes_of(level.lobe),
                                        {"alpha", "alpha_along", "yarn_deg"}, as_half);
          !ok)
        return ok;
      listed.push_back({{"level", level.level},
                        {"width", level.normal.width()},
                        {"height", level.normal.height()},
                        {"mean_alpha", level.mean_alpha}});
    }
    levels_ = std::move(*levels);
    if (listed.empty()) return {};
    MapFacts facts = {
        .name = "mips", .file = "mips/lobe_LL.exr", .channels = {"alpha", "alpha_along", "yarn_deg"}};
    measure(facts, levels_.front().lobe.plane(0));
    facts.more = {{"rule", name_of(MipRule::kVmf)}, {"levels", std::move(listed)}};
    maps_.push_back(json_of(facts));
    return {};
  }

  Result<void> write_weights() {
    Result<ParameterField> weights = stack_.weights();
    if (!weights) return std::move(weights).error();
    if (!weights->is_map()) return {};
    return write(
        {.name = "weights", .unit = "share", .channels = {"R", "G", "B"}, .source = MapSource::kAssumed},
        weights->map);
  }

  Result<void> draw() {
    if (!options_.has_pictures) return {};
    point_.alpha = point_.alpha_along = alpha_;
    const PreviewMaps maps = {
        .surface = surface_, .levels = levels_, .size_mm = node_.size_mm, .point = point_};
    return solve::write_png(folder_ / "preview.png", preview_of(maps, context_.threads));
  }

  Json document() const {
    Json layers = Json::array(), runtime = Json::array();
    for (const Json& layer : node_.inputs["layers"])
      layers.push_back({{"name", layer["name"]}, {"material", layer["of"]}, {"id", layer["material"]}});
    for (const Json& layer : node_.inputs["runtime_layers"])
      runtime.push_back({{"name", layer["name"]}, {"material", layer["of"]}, {"id", layer["material"]}});
    Json document = {{"schema", std::string(kMaterialProduct.schema) + "/1"},
                     {"id", node_.id},
                     {"name", node_.name},
                     {"width", node_.size.width},
                     {"height", node_.size.height}};
    if (node_.size_mm) {
      document["mm_per_pixel"] = node_.mm_per_pixel();
      document["size_mm"] = *node_.size_mm;
      if (!node_.is_size_known) document["size_known"] = false;
    }
    document["is_tile"] = node_.is_tile;
    document["albedo_scale"] = "absolute";
    document["maps"] = maps_;
    document["parameters"] = parameters_;
    document["layers"] = std::move(layers);
    if (!runtime.empty()) {
      const bool has_map = node_.maps.contains("runtime.weights");
      document["runtime"] = {{"weights", has_map ? "weights.exr" : "vertex-color"},
                             {"layers", std::move(runtime)}};
    }
    if (options_.has_pictures) document["preview"] = "preview.png";
    document["inputs"] = node_.inputs;
    document["verdicts"] = json_of(verdicts_);
    return document;
  }

  const MaterialNode& node_;
  MaterialStack stack_;
  fs::path folder_;
  const ComposeOptions& options_;
  const JobContext& context_;
  Surface surface_;
  bool has_relief_ = false;
  double alpha_ = 0.49;
  ShadedPoint point_;
  std::vector<MipLevel> levels_;
  Json maps_ = Json::array(), parameters_ = Json::object();
  std::vector<Verdict> verdicts_;
};

}  // namespace

Result<Json> compose_material(const MaterialNode& node, std::vector<MapSet> layers, const fs::path& folder,
                              const ComposeOptions& options, const JobContext& context) {
  Result<MaterialStack> stack = MaterialStack::open(node, std::move(layers), context.threads);
  if (!stack) return std::move(stack).error();
  return Composer(node, std::move(*stack), folder, options, context).run();
}

}  // namespace weft::material
