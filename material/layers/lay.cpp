// SPDX-License-Identifier: Apache-2.0
#include "material/layers/lay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/vec.h"
#include "material/filtering/joined_gloss.h"

namespace weft::material {
namespace {

constexpr double kSteepest = 57.28996163075943;  // tan of 89 degrees

using Values = std::array<double, 3>;

// What a layer makes of values below at one place.
using Blend = void (*)(Values& below, const Values& layer, double mask, const Values& means);

void replace(Values& below, const Values& layer, double mask, const Values&) {
  for (std::size_t p = 0; p < below.size(); ++p) below[p] += mask * (layer[p] - below[p]);
}

void add_less_mean(Values& below, const Values& layer, double mask, const Values& means) {
  for (std::size_t p = 0; p < below.size(); ++p) below[p] += mask * (layer[p] - means[p]);
}

void multiply_by_ratio(Values& below, const Values& layer, double mask, const Values& means) {
  for (std::size_t p = 0; p < below.size(); ++p) {
    if (means[p] > 0) below[p] *= 1 + mask * (layer[p] / means[p] - 1);
  }
}

Vec3 normal_of(double slope_x, double slope_y) {
  return normalized({-slope_x, -slope_y, 1});
}

template <NormalBlend kind>
void join_normals(Values& below, const Values& layer, double mask, const Values& means) {
  const Vec3 detail = normal_of(mask * (layer[0] - means[0]), mask * (layer[1] - means[1]));
  const Vec3 joined = blended(normal_of(below[0], below[1]), detail, kind);
  const std::array<double, 2> slopes = slopes_of_normal(joined.x, joined.y, joined.z);
  below[0] = slopes[0];
  below[1] = slopes[1];
}

// Joins lobes by the roots of their alphas, as the parameter has them.
void join_lobes(Values& below, const Values& layer, double mask, const Values&) {
  if (mask > 0) below[0] = std::sqrt(joined_alpha(below[0] * below[0], mask * layer[0] * layer[0]));
}

Blend joining(NormalBlend normals) {
  switch (normals) {
    case NormalBlend::kAddSlopes:
      return add_less_mean;
    case NormalBlend::kWhiteout:
      return join_normals<NormalBlend::kWhiteout>;
    case NormalBlend::kRnm:
      return join_normals<NormalBlend::kRnm>;
    case NormalBlend::kBlendXy:
      return join_normals<NormalBlend::kBlendXy>;
  }
  return add_less_mean;
}

// None where the layer leaves the parameter alone.
Blend blend_of(Parameter parameter, const LayOptions& options) {
  if (options.blend == LayerBlend::kReplace) return replace;
  if (parameter == Parameter::kAlbedo) return multiply_by_ratio;
  if (parameter == Parameter::kNormal) return joining(options.normals);
  if (parameter == Parameter::kHeight) return add_less_mean;
  if (parameter == Parameter::kRoughness) return join_lobes;
  return nullptr;
}

Values values_at(const ParameterField& field, int x, int y) {
  Values values = {};
  for (int p = 0; p < field.planes; ++p) values[static_cast<std::size_t>(p)] = field.at(x, y, p);
  return values;
}

Error misfit(const char* what, Size a, Size b) {
  return {ErrorKind::kUsage, "a layer does not fit what it lies on", what,
          fmt::format("{} x {} pixels on {} x {}", a.width, a.height, b.width, b.height),
          "bring it to the grid below first"};
}

// The grid of those fields that are maps; no size where none is.
Result<Size> common_grid(const ParameterField& below, const ParameterField& layer,
                         const ParameterField& mask) {
  Size size;
  for (const ParameterField* field : {&below, &layer, &mask}) {
    if (!field->is_map()) continue;
    if (size.pixels() != 0 && !(size == field->map.size()))
      return misfit("its maps", field->map.size(), size);
    size = field->map.size();
  }
  if (below.planes != layer.planes || mask.planes != 1)
    return misfit("its planes", {layer.planes, mask.planes}, {below.planes, 1});
  return size;
}

Image<float> filled(const ParameterField& field, Size size) {
  Image<float> map(size, field.planes);
  for (int p = 0; p < field.planes; ++p) {
    const float value = static_cast<float>(field.constant[static_cast<std::size_t>(p)]);
    for (int y = 0; y < size.height; ++y) std::fill_n(map.plane(p).row(y), size.width, value);
  }
  return map;
}

}  // namespace

const char* name_of(LayerBlend blend) {
  return blend == LayerBlend::kDetail ? "detail" : "replace";
}

std::optional<LayerBlend> layer_blend_named(std::string_view name) {
  for (const LayerBlend blend : {LayerBlend::kReplace, LayerBlend::kDetail}) {
    if (name == name_of(blend)) return blend;
  }
  return {};
}

ParameterField copy_of(const ParameterField& field) {
  ParameterField copy = {field.planes, field.constant, {}};
  if (!field.is_map()) return copy;
  copy.map = Image<float>(field.map.size(), field.planes);
  for (int p = 0; p < field.planes; ++p) {
    for (int y = 0; y < field.map.height(); ++y)
      std::copy_n(field.map.plane(p).row(y), field.map.width(), copy.map.plane(p).row(y));
  }
  return copy;
}

std::array<double, 3> means_of(const ParameterField& field) {
  if (!field.is_map()) return field.constant;
  std::array<double, 3> means = {};
  for (int p = 0; p < field.planes; ++p) {
    double sum = 0;
    for (int y = 0; y < field.map.height(); ++y) {
      const float* row = field.map.plane(p).row(y);
      for (int x = 0; x < field.map.width(); ++x) sum += double{row[x]};
    }
    means[static_cast<std::size_t>(p)] = sum / static_cast<double>(field.map.size().pixels());
  }
  return means;
}

std::array<double, 2> slopes_of_normal(double x, double y, double z) {
  const double along = std::hypot(x, y);
  if (!(along > 0)) return {0, 0};
  const double steepness = z > along / kSteepest ? along / z : kSteepest;
  return {-x / along * steepness, -y / along * steepness};
}

std::array<double, 2> axis_of(double anisotropy, double azimuth_deg) {
  const double twice = 2 * radians(azimuth_deg);
  return {anisotropy * std::cos(twice), anisotropy * std::sin(twice)};
}

YarnAxis axis_from(double cosine, double sine) {
  const double anisotropy = std::hypot(cosine, sine);
  if (!(anisotropy > 0)) return {};
  const double azimuth_deg = degrees(std::atan2(sine, cosine)) / 2;
  const double positive = azimuth_deg < 0 ? azimuth_deg + 180 : azimuth_deg;
  return {std::min(anisotropy, 1.0), positive < 180 ? positive : 0};
}

Result<void> lay(Parameter parameter, ParameterField& below, const ParameterField& layer,
                 const ParameterField& mask, const LayOptions& options) {
  const Blend blend = blend_of(parameter, options);
  if (blend == nullptr) return {};
  const Result<Size> grid = common_grid(below, layer, mask);
  if (!grid) return grid.error();
  const Values means = options.blend == LayerBlend::kDetail ? means_of(layer) : Values{};
  const auto mask_at = [&](int x, int y) { return std::clamp(mask.at(x, y) * options.alpha, 0.0, 1.0); };
  if (!below.is_map() && !layer.is_map()) {
    Values all = below.constant;
    blend(all, layer.constant, 1, means);
    if (!mask.is_map() || all == below.constant) {
      blend(below.constant, layer.constant, mask_at(0, 0), means);
      return {};
    }
  }
  if (!below.is_map()) below.map = filled(below, *grid);
  parallel_for(static_cast<std::size_t>(grid->height), options.threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < grid->width; ++x) {
      Values values = values_at(below, x, y);
      blend(values, values_at(layer, x, y), mask_at(x, y), means);
      for (int p = 0; p < below.planes; ++p)
        below.map(x, y, p) = static_cast<float>(values[static_cast<std::size_t>(p)]);
    }
  });
  return {};
}

void multiply(ParameterField& field, const std::array<double, 3>& factors, int threads) {
  if (!field.is_map()) {
    for (std::size_t p = 0; p < factors.size(); ++p) field.constant[p] *= factors[p];
    return;
  }
  parallel_for(static_cast<std::size_t>(field.map.height()), threads, [&](std::size_t y, int) {
    for (int p = 0; p < field.planes; ++p) {
      float* row = field.map.plane(p).row(static_cast<int>(y));
      const double factor = factors[static_cast<std::size_t>(p)];
      for (int x = 0; x < field.map.width(); ++x) row[x] = static_cast<float>(factor * double{row[x]});
    }
  });
}

std::int64_t clamp_to(ParameterField& field, double least, double most) {
  std::int64_t changed = 0;
  if (!field.is_map()) {
    for (int p = 0; p < field.planes; ++p) {
      double& value = field.constant[static_cast<std::size_t>(p)];
      const double within = std::clamp(value, least, most);
      changed += within != value;
      value = within;
    }
    return changed;
  }
  const float low = static_cast<float>(least), high = static_cast<float>(most);
  for (int p = 0; p < field.planes; ++p) {
    for (int y = 0; y < field.map.height(); ++y) {
      float* row = field.map.plane(p).row(y);
      for (int x = 0; x < field.map.width(); ++x) {
        const float within = std::clamp(row[x], low, high);
        changed += within != row[x];
        row[x] = within;
      }
    }
  }
  return changed;
}

}  // namespace weft::material
