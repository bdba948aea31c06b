// SPDX-License-Identifier: Apache-2.0
// Roughness: what was measured, or what is typed in its place, its scales, and its coarser levels.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <utility>

#include "calibration/guide/planned_cloth.h"
#include "core/base/files.h"
#include "core/image_io/image_io.h"
#include "core/solve/solve_record.h"
#include "material/filtering/joined_gloss.h"
#include "material/filtering/roughness_mips.h"
#include "material/run/derived_maps.h"
#include "material/run/surface_files.h"
#include "solve/files/gloss_maps.h"

namespace weft::material {
namespace {

using solver::Lobe;

// What an artist would type: that of a pile is matt, since its sheen is no lobe of GGX.
Lobe typed_lobe(const std::string& cloth) {
  const std::vector<calibration::NamedCloth>& cloths = calibration::planned_cloths();
  const auto known = std::ranges::find(cloths, cloth, &calibration::NamedCloth::name);
  const Lobe named = known == cloths.end() ? Lobe() : known->cloth.lobe;
  if (named.family != solver::LobeFamily::kLambert && named.family != solver::LobeFamily::kCloth)
    return named;
  return {.family = solver::LobeFamily::kGgx, .alpha = solve::kTypedAlpha, .f0 = solve::kTypedF0};
}

double typed_alpha(const std::string& cloth) {
  const Lobe lobe = typed_lobe(cloth);
  return lobe.alpha * std::sqrt(lobe.along);
}

std::string typed_words(const MapWork& work) {
  if (work.options.cloth.empty())
    return "not known: the photographs do not tell it, and nobody said what kind of cloth it is";
  return fmt::format("by its kind, {}: the photographs do not tell it", work.options.cloth);
}

// The geometric mean of both alphas.
Image<float> mean_alphas(const Image<float>& lobe) {
  Image<float> alpha(lobe.size());
  for (int y = 0; y < lobe.height(); ++y) {
    for (int x = 0; x < lobe.width(); ++x) alpha(x, y) = std::sqrt(lobe(x, y, 0) * lobe(x, y, 1));
  }
  return alpha;
}

Image<float> on_scale(GlossScale scale, const Image<float>& alpha) {
  Image<float> values(alpha.size());
  for (int y = 0; y < alpha.height(); ++y) {
    for (int x = 0; x < alpha.width(); ++x)
      values(x, y) = static_cast<float>(on_scale(scale, static_cast<double>(alpha(x, y))));
  }
  return values;
}

// f0 of R, G and B over the largest of them.
Image<float> tint_of(const Image<float>& lobe) {
  Image<float> tint(lobe.size(), 3);
  for (int y = 0; y < lobe.height(); ++y) {
    for (int x = 0; x < lobe.width(); ++x) {
      const float most = lobe(x, y, 3);
      for (int c = 0; c < 3; ++c) tint(x, y, c) = most > 0 ? std::min(lobe(x, y, 4 + c) / most, 1.0F) : 1.0F;
    }
  }
  return tint;
}

// Pixels that were solved with a lobe; the others have typed values.
double measured_share(const Surface& surface) {
  std::int64_t glossy = 0;
  for (int y = 0; y < surface.size().height; ++y) {
    const std::uint16_t* row = surface.status.plane().row(y);
    glossy += std::count_if(row, row + surface.size().width, [](auto bits) { return (bits & kGlossy) != 0; });
  }
  return static_cast<double>(glossy) / static_cast<double>(surface.size().pixels());
}

}  // namespace

Result<void> make_roughness(MapWork& work) {
  MapFacts roughness = {.name = "roughness", .source = MapSource::kMeasured};
  roughness.more = {{"scale", name_of(GlossScale::kRoughness)}};
  MapFacts specular = {.name = "specular", .unit = "share", .source = MapSource::kMeasured};
  if (work.surface.lobe.empty()) {
    const Lobe lobe = typed_lobe(work.options.cloth);
    roughness.source = specular.source = MapSource::kAssumed;
    roughness.more["alpha"] = lobe.alpha;
    roughness.more["alpha_along"] = lobe.alpha * lobe.along;
    write_constant(work, std::move(roughness), std::sqrt(typed_alpha(work.options.cloth)), typed_words(work));
    write_constant(work, std::move(specular), lobe.f0, typed_words(work));
    return {};
  }
  // The files are those of the surface.
  const double share = measured_share(work.surface);
  roughness.more["measured_share"] = specular.more["measured_share"] = share;
  roughness.file = "roughness.exr";
  roughness.channels = {"roughness", "alpha", "alpha_along", "yarn_deg"};
  const Image<float> shown = on_scale(GlossScale::kRoughness, mean_alphas(work.surface.lobe));
  if (Result<void> ok = draw_map(work, std::move(roughness), {shown.plane()}); !ok) return ok;
  if (!work.has_f0) {
    specular.source = MapSource::kAssumed;
    specular.more = Json::object();
    write_constant(work, std::move(specular), solve::kTypedF0, "typed, as the albedo has no absolute scale");
    return {};
  }
  specular.file = "specular.exr";
  specular.channels = {"f0"};
  const bool is_tinted = work.surface.lobe.planes() > 4;
  if (is_tinted) specular.channels = {"f0", "R", "G", "B"};
  if (Result<void> ok = draw_map(work, std::move(specular), {work.surface.lobe.plane(3)}); !ok || !is_tinted)
    return ok;
  const Image<float> tint = tint_of(work.surface.lobe);
  return write_map(work,
                   {.name = "specular_tint",
                    .file = "specular_tint.exr",
                    .unit = "share",
                    .channels = {"R", "G", "B"},
                    .source = MapSource::kMeasured,
                    .more = {{"measured_share", share}}},
                   planes_of(tint));
}

Result<void> make_gloss(MapWork& work) {
  MapFacts facts = {.name = "gloss"};
  if (work.surface.lobe.empty()) {
    const double alpha = typed_alpha(work.options.cloth);
    facts.source = MapSource::kAssumed;
    facts.more = {{"blinn_phong", on_scale(GlossScale::kBlinnPhong, alpha)}};
    write_constant(work, std::move(facts), on_scale(GlossScale::kGloss, alpha), typed_words(work));
    return {};
  }
  const Image<float> alpha = mean_alphas(work.surface.lobe);
  const Image<float> gloss = on_scale(GlossScale::kGloss, alpha);
  const Image<float> power = on_scale(GlossScale::kBlinnPhong, alpha);
  facts.file = "gloss.exr";
  facts.channels = {"gloss", "blinn_phong"};
  return write_map(work, std::move(facts), {gloss.plane(), power.plane()});
}

Result<void> make_mips(MapWork& work) {
  const Lobe typed = typed_lobe(work.options.cloth);
  const Result<std::vector<MipLevel>> levels = roughness_mips(
      work.surface, {.alpha = typed.alpha, .along = typed.along, .threads = work.context.threads});
  if (!levels) return levels.error();
  const std::filesystem::path folder = work.folder / "mips";
  if (Result<void> ok = make_writable_folder(folder); !ok) return ok;
  Json listed = Json::array();
  for (const MipLevel& level : *levels) {
    const std::string number = fmt::format("{:02}", level.level);
    const PixelPitch pitch_mm = pitch_of_level(work, level.normal.size());
    const Result<void> normal =
        write_image(folder / ("normal_" + number + ".exr"), planes_of(level.normal), {"X", "Y", "Z"},
                    {.compression = work.compression, .pitch_mm = pitch_mm});
    if (!normal) return normal;
    const Result<void> lobe = write_image(
        folder / ("lobe_" + number + ".exr"), planes_of(level.lobe), {"alpha", "alpha_along", "yarn_deg"},
        {.type = SampleType::kHalf, .compression = work.compression, .pitch_mm = pitch_mm});
    if (!lobe) return lobe;
    listed.push_back({{"level", level.level},
                      {"width", level.normal.width()},
                      {"height", level.normal.height()},
                      {"mean_alpha", level.mean_alpha}});
  }
  if (listed.empty()) return {};
  MapFacts facts = {.name = "mips",
                    .file = "mips/lobe_LL.exr",
                    .channels = {"alpha", "alpha_along", "yarn_deg"},
                    .source = work.surface.lobe.empty() ? MapSource::kAssumed : MapSource::kDerived};
  measure(facts, levels->front().lobe.plane(0));
  facts.more = {{"rule", name_of(MipRule::kVmf)}, {"levels", std::move(listed)}};
  work.made.push_back(std::move(facts));
  return {};
}

}  // namespace weft::material
