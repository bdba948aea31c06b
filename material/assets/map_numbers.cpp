// SPDX-License-Identifier: Apache-2.0
// Numbers of files as fields of parameters.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/image/color_spaces.h"
#include "core/image_io/image_io.h"
#include "core/image_io/linear_image.h"
#include "material/assets/map_set.h"
#include "material/filtering/joined_gloss.h"
#include "material/read/file_meaning.h"

namespace weft::material {
namespace {

using Values = std::array<double, 3>;

// What half floats and whole steps may lie outside a range.
constexpr double kOutside = 2e-3;

Error bad_map(const MapFile& map, const std::string& where, std::string why, std::string remedy) {
  return {ErrorKind::kBadData, "the material cannot be used", where + ": " + map.file.string(),
          std::move(why), std::move(remedy)};
}

// Planes of the channels that are wanted.
Result<std::vector<View<const float>>> planes_wanted(const LoadedImage& image, const MapFile& map,
                                                     std::size_t count, const std::string& where) {
  std::vector<View<const float>> planes;
  std::string there;
  for (const std::string& name : image.info.channels) there += (there.empty() ? "" : ", ") + name;
  const auto refuse = [&](const std::string& wanted) {
    return bad_map(map, where, fmt::format("it has no channel {}; it has {}", wanted, there),
                   "name one with channel");
  };
  for (const std::string& name : map.channels) {
    planes.push_back(image.channel(name));
    if (planes.back().empty()) return refuse(name);
  }
  if (map.channels.empty()) {
    if (image.info.channels.size() < count)
      return refuse(fmt::format("number {}", image.info.channels.size() + 1));
    for (std::size_t p = 0; p < count; ++p) planes.push_back(image.planes.plane(static_cast<int>(p)));
  }
  if (planes.size() < count)
    return bad_map(map, where, fmt::format("{} channels are wanted, and {} named", count, planes.size()),
                   "leave channel out");
  return planes;
}

double perceptual(double value, const std::string& unit) {
  const auto scale = gloss_scale_named(unit);
  if (!scale || *scale == GlossScale::kRoughness) return value;
  return on_scale(GlossScale::kRoughness, alpha_of(*scale, value));
}

// A parameter of roughness.exr: whatever way its axes stand, the broad one is across the yarn.
double of_lobe(Parameter parameter, const Values& lobe) {
  const double broad = std::max(lobe[0], lobe[1]), narrow = std::min(lobe[0], lobe[1]);
  if (parameter == Parameter::kRoughness) return std::sqrt(std::max(broad, 0.0));
  if (parameter == Parameter::kAnisotropy) return broad > 0 ? std::clamp(1 - narrow / broad, 0.0, 1.0) : 0;
  const double azimuth_deg = lobe[1] > lobe[0] ? lobe[2] + 90 : lobe[2];
  const double rest = std::fmod(azimuth_deg, 180.0);
  return rest < 0 ? rest + 180 : rest;
}

struct Conversion {
  Parameter parameter;
  const ParameterFacts& facts;
  const MapFile& map;
  bool is_srgb = false;
  double scale = 1, offset = 0;
  double least = 0, most = 1;
};

bool is_packed(const ImageFileInfo& info, const std::vector<View<const float>>& planes) {
  const bool is_integer = info.type == SampleType::kUint8 || info.type == SampleType::kUint16;
  return is_integer || (planes.size() == 3 && are_packed_normals({planes[0], planes[1], planes[2]}));
}

Conversion conversion_of(Parameter parameter, const MapFile& map, const ImageFileInfo& info,
                         const std::vector<View<const float>>& planes) {
  const ParameterFacts& facts = facts_of(parameter);
  Conversion to = {parameter, facts, map};
  to.is_srgb =
      map.is_srgb.value_or(facts.kind == ParameterKind::kColour && transfer_of(info) == Transfer::kSrgb);
  const bool is_packed_normal = facts.kind == ParameterKind::kNormal && !map.scale && is_packed(info, planes);
  to.scale = map.scale.value_or(is_packed_normal ? 2 : 1);
  to.offset = map.offset.value_or(is_packed_normal ? -1 : 0);
  const bool is_albedo = parameter == Parameter::kAlbedo;
  to.least = is_albedo ? -1 : facts.least;
  to.most = is_albedo ? 4 : facts.most;
  return to;
}

// The parameter of the file's values, and nothing where they can be none.
bool convert(const Conversion& to, Values& v, std::size_t count) {
  for (std::size_t p = 0; p < count; ++p) {
    if (!std::isfinite(v[p])) return false;
  }
  if (to.map.is_lobe) {
    v[0] = of_lobe(to.parameter, v);
    count = 1;
  }
  if (to.is_srgb) v = rec709_of_srgb(v);
  for (std::size_t p = 0; p < count; ++p) v[p] = to.scale * v[p] + to.offset;
  if (to.facts.kind == ParameterKind::kNormal) {
    if (count == 2) v[2] = std::sqrt(std::max(0.0, 1 - v[0] * v[0] - v[1] * v[1]));
    const double length = std::hypot(v[0], v[1], v[2]);
    if (!(length > 0.5 && length < 1.5)) return false;
    const auto slopes = slopes_of_normal(v[0], to.map.y_is_down ? -v[1] : v[1], v[2]);
    v = {slopes[0], slopes[1], 0};
    return true;
  }
  const bool is_gloss = !to.map.is_lobe &&
                        (to.parameter == Parameter::kRoughness || to.parameter == Parameter::kSheenRoughness);
  if (is_gloss && !to.map.scale) v[0] = perceptual(v[0], to.map.unit);
  for (std::size_t p = 0; p < count; ++p) {
    if (!(v[p] >= to.least - kOutside && v[p] <= to.most + kOutside)) return false;
    v[p] = std::clamp(v[p], to.least, to.most);
  }
  return true;
}

ParameterField same_field(Parameter parameter, const std::vector<double>& values) {
  const ParameterFacts& facts = facts_of(parameter);
  Values v = {};
  std::copy_n(values.begin(), std::min(values.size(), v.size()), v.begin());
  if (facts.kind == ParameterKind::kNormal) {
    const auto slopes = slopes_of_normal(v[0], v[1], v[2]);
    return ParameterField::same({slopes[0], slopes[1], 0}, 2);
  }
  return ParameterField::same(v, numbers_of(facts.kind));
}

std::string range_words(const Conversion& to) {
  if (to.facts.kind == ParameterKind::kNormal)
    return "no unit normal; say scale and offset if it is packed another way";
  return fmt::format("out of {:g} to {:g}{}{}; say scale if it is in another unit", to.least, to.most,
                     *to.facts.unit == 0 ? "" : " ", to.facts.unit);
}

}  // namespace

Result<ParameterField> read_field(Parameter parameter, const MapFile& map, const std::string& where) {
  if (map.same) return same_field(parameter, *map.same);
  const Result<LoadedImage> image = read_samples(map.file);
  if (!image) return image.error();
  const ParameterFacts& facts = facts_of(parameter);
  // The third part of a normal follows from two.
  const bool lacks_z = facts.kind == ParameterKind::kNormal && map.channels.size() == 2;
  const std::size_t count = map.is_lobe ? 3 : lacks_z ? 2 : static_cast<std::size_t>(numbers_of(facts.kind));
  const Result<std::vector<View<const float>>> planes = planes_wanted(*image, map, count, where);
  if (!planes) return planes.error();
  const Conversion to = conversion_of(parameter, map, image->info, *planes);
  const int kept = facts.kind == ParameterKind::kNormal ? 2 : map.is_lobe ? 1 : static_cast<int>(count);
  Image<float> field(image->info.size, kept);
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      Values v = {};
      for (std::size_t p = 0; p < count; ++p) v[p] = double{(*planes)[p](x, y)};
      const Values read = v;
      if (!convert(to, v, count)) {
        return bad_map(
            map, where,
            fmt::format("{} at column {}, row {} is {:g}{}, {}", facts.name, x, y, read[0],
                        count > 1 ? fmt::format(", {:g}, {:g}", read[1], read[2]) : "", range_words(to)),
            "correct the map");
      }
      for (int p = 0; p < kept; ++p) field(x, y, p) = static_cast<float>(v[static_cast<std::size_t>(p)]);
    }
  }
  return ParameterField::of(std::move(field));
}

Result<ParameterField> read_mask(const MapFile& map, std::size_t channel, const std::string& where) {
  if (map.same) return ParameterField::same(map.same->front());
  const Result<LoadedImage> image = read_samples(map.file);
  if (!image) return image.error();
  MapFile one = map;
  if (one.channels.empty()) {
    if (channel >= image->info.channels.size())
      return bad_map(map, where,
                     fmt::format("it has {} channels, and number {} is wanted", image->info.channels.size(),
                                 channel + 1),
                     "give a map with as many");
    one.channels = {image->info.channels[channel]};
  }
  one.channels.resize(1);
  const Result<std::vector<View<const float>>> planes = planes_wanted(*image, one, 1, where);
  if (!planes) return planes.error();
  Image<float> field(image->info.size);
  const double scale = map.scale.value_or(1), offset = map.offset.value_or(0);
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      const double value = scale * double{planes->front()(x, y)} + offset;
      if (!std::isfinite(value))
        return bad_map(map, where, fmt::format("the mask at column {}, row {} is no number", x, y),
                       "correct the map");
      field(x, y) = static_cast<float>(value);
    }
  }
  return ParameterField::of(std::move(field));
}

}  // namespace weft::material
