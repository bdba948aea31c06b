// SPDX-License-Identifier: Apache-2.0
#include "material/assets/stack.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/parallel.h"
#include "material/layers/fit.h"
#include "material/layers/lay.h"
#include "material/layers/masks.h"

namespace weft::material {
namespace {

using enum Parameter;

constexpr double kMaskRadius_mm = 0.5;

bool has(const KeptValues& values, Parameter parameter) {
  return values.contains(facts_of(parameter).name);
}

std::array<double, 3> three(const Json& numbers, double otherwise) {
  std::array<double, 3> all = {otherwise, otherwise, otherwise};
  for (std::size_t i = 0; i < std::min(numbers.size(), all.size()); ++i) all[i] = numbers[i].get<double>();
  return all;
}

// A typed value as a field.
ParameterField typed_field(Parameter parameter, const std::array<double, 3>& v) {
  const ParameterFacts& facts = facts_of(parameter);
  if (facts.kind != ParameterKind::kNormal) return ParameterField::same(v, numbers_of(facts.kind));
  const auto slopes = slopes_of_normal(v[0], v[1], v[2]);
  return ParameterField::same({slopes[0], slopes[1], 0}, 2);
}

// Anisotropies and azimuths as axes.
ParameterField axes_of(const ParameterField& anisotropy, const ParameterField& azimuth_deg, int threads) {
  if (!anisotropy.is_map() && !azimuth_deg.is_map()) {
    const auto axis = axis_of(anisotropy.constant[0], azimuth_deg.constant[0]);
    return ParameterField::same({axis[0], axis[1], 0}, 2);
  }
  const Size size = anisotropy.is_map() ? anisotropy.map.size() : azimuth_deg.map.size();
  Image<float> map(size, 2);
  parallel_for(static_cast<std::size_t>(size.height), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size.width; ++x) {
      const auto axis = axis_of(anisotropy.at(x, y), azimuth_deg.at(x, y));
      map(x, y, 0) = static_cast<float>(axis[0]);
      map(x, y, 1) = static_cast<float>(axis[1]);
    }
  });
  return ParameterField::of(std::move(map));
}

// A typed factor of a table, where it has one.
std::array<double, 3> factor_of(const KeptValues& values, Parameter factor) {
  const auto found = values.find(facts_of(factor).name);
  if (found == values.end()) return {1, 1, 1};
  const Json& numbers = found->second.value;
  return three(numbers, numbers.size() == 1 ? numbers[0].get<double>() : 1);
}

// Tint of an albedo and scale of slopes, of the same table.
void apply_factors(const KeptValues& values, Parameter parameter, ParameterField& field, int threads) {
  if (parameter != kAlbedo && parameter != kNormal) return;
  const auto factor = factor_of(values, parameter == kAlbedo ? kAlbedoTint : kNormalScale);
  if (factor != std::array<double, 3>{1, 1, 1}) multiply(field, factor, threads);
}

BlendSpace space_of(Parameter parameter) {
  return facts_of(parameter).blend;
}

Result<ParameterField> built_field(const MapSet& set, Parameter parameter, int threads) {
  if (parameter != kAnisotropy) return read_built(set, parameter);
  const Result<ParameterField> anisotropy = read_built(set, kAnisotropy);
  if (!anisotropy) return anisotropy.error();
  const Result<ParameterField> azimuth = read_built(set, kAnisotropyDeg);
  if (!azimuth) return azimuth.error();
  return axes_of(*anisotropy, *azimuth, threads);
}

// A mask of any size over the whole grid.
ParameterField stretched(const ParameterField& mask, Size size, bool wraps, int threads) {
  if (!mask.is_map() || mask.map.size() == size) return copy_of(mask);
  return fitted(mask, BlendSpace::kLinear, {.wraps = wraps}, size, threads);
}

// The source of a parameter in a built material.
std::string built_source(const MapSet& set, Parameter parameter) {
  const char* name = facts_of(parameter).name;
  const Json& parameters = set.document["parameters"];
  if (parameters.contains(name)) return parameters[name].value("source", "assumed");
  const std::string map = parameter == kHeight                                      ? "height"
                          : parameter == kAnisotropy || parameter == kAnisotropyDeg ? "roughness"
                                                                                    : name;
  for (const Json& each : set.document["maps"]) {
    if (each.value("name", "") == map) return each.value("source", "assumed");
  }
  return "assumed";
}

// Whether a built material tells its roughness, and has not that of nothing said.
bool tells_roughness(const MapSet& set) {
  const auto inputs = set.document.find("inputs");
  if (inputs == set.document.end()) return true;
  const char* name = facts_of(kRoughness).name;
  const auto says = [&](const char* table) {
    return inputs->contains(table) && (*inputs)[table].contains(name);
  };
  return says("surface") || says("over") || !inputs->value("layers", Json::array()).empty();
}

}  // namespace

Result<MaterialStack> MaterialStack::open(const MaterialNode& node, std::vector<MapSet> layers, int threads) {
  MaterialStack stack(node, std::move(layers), threads);
  if (Result<void> ok = stack.find_masks(); !ok) return std::move(ok).error();
  return stack;
}

Result<ParameterField> MaterialStack::table_value(const char* table, const KeptValues& values,
                                                  Parameter parameter) const {
  const ParameterFacts& facts = facts_of(parameter);
  const auto found = values.find(facts.name);
  if (found == values.end()) return typed_field(parameter, facts.otherwise);
  const std::string key = fmt::format("{}.{}", table, facts.name);
  const auto map = node_->maps.find(key);
  if (map == node_->maps.end()) return typed_field(parameter, three(found->second.value, 0));
  return read_field(parameter, map->second, found->second.from + ": " + key);
}

Result<ParameterField> MaterialStack::own(Parameter parameter) const {
  const KeptValues& values = node_->material.surface;
  Result<ParameterField> field = table_value("surface", values, parameter);
  if (!field) return field;
  if (parameter == kAnisotropy) {
    const Result<ParameterField> azimuth = table_value("surface", values, kAnisotropyDeg);
    if (!azimuth) return azimuth.error();
    return axes_of(*field, *azimuth, threads_);
  }
  apply_factors(values, parameter, *field, threads_);
  return field;
}

bool MaterialStack::reaches(std::size_t i, Parameter parameter) const {
  const KeptValues& values = node_->material.layers[i].values;
  const auto only = values.find("only");
  if (only == values.end()) return true;
  const auto names = [&](Parameter each) {
    return std::ranges::find(only->second.value, Json(facts_of(each).name)) != only->second.value.end();
  };
  return names(parameter) || (parameter == kAnisotropy && names(kAnisotropyDeg));
}

bool MaterialStack::changes(std::size_t i, Parameter parameter) const {
  if (!reaches(i, parameter)) return false;
  const KeptValues& values = node_->material.layers[i].values;
  const auto blend = values.find("blend");
  if (blend == values.end() || blend->second.value != "detail") return true;
  if (parameter == kRoughness) return tells_roughness(layers_[i]);
  return parameter == kAlbedo || parameter == kNormal || parameter == kHeight;
}

Result<void> MaterialStack::lay_layer(std::size_t i, Parameter parameter, ParameterField& below) const {
  if (!changes(i, parameter)) return {};
  const KeptValues& values = node_->material.layers[i].values;
  const auto word = [&](const char* key, const char* otherwise) {
    const auto found = values.find(key);
    return found == values.end() ? std::string(otherwise) : found->second.value.get<std::string>();
  };
  const LayOptions options = {.blend = *layer_blend_named(word("blend", "replace")),
                              .normals = *normal_blend_named(word("normals", "add-slopes")),
                              .alpha = values.contains("alpha") ? values.at("alpha").value.get<double>() : 1,
                              .threads = threads_};
  const Result<ParameterField> read = built_field(layers_[i], parameter, threads_);
  if (!read) return read.error();
  ParameterField layer = fitted(*read, space_of(parameter), *node_->fits[i], node_->size, threads_);
  if (parameter == kAlbedo && values.contains("tint"))
    multiply(layer, three(values.at("tint").value, 1), threads_);
  return lay(parameter, below, layer, masks_[i], options);
}

Result<void> MaterialStack::put_over(Parameter parameter, ParameterField& field) const {
  const KeptValues& over = node_->material.over;
  const bool has_axis = parameter == kAnisotropy && has(over, kAnisotropyDeg);
  if (has(over, parameter) || has_axis) {
    Result<ParameterField> value = table_value("over", over, parameter);
    if (!value) return std::move(value).error();
    if (parameter == kAnisotropy) {
      const Result<ParameterField> azimuth = table_value("over", over, kAnisotropyDeg);
      if (!azimuth) return azimuth.error();
      *value = axes_of(*value, *azimuth, threads_);
    }
    field = std::move(*value);
  }
  apply_factors(over, parameter, field, threads_);
  return {};
}

Result<ParameterField> MaterialStack::mask_of(std::size_t i, const ParameterField& height_mm) const {
  const MaterialLayer& layer = node_->material.layers[i];
  const auto found = layer.values.find("mask");
  if (found == layer.values.end()) return ParameterField::same(1);
  const Json& rule = found->second.value;
  if (rule.contains("value")) return ParameterField::same(rule["value"].get<double>());
  const std::string key = "layer." + layer.name + ".mask";
  MaskLevels levels;
  ParameterField mask;
  if (rule.contains("map")) {
    Result<ParameterField> read = read_mask(node_->maps.at(key), 0, found->second.from + ": " + key);
    if (!read) return read;
    mask = stretched(*read, node_->size, node_->is_tile, threads_);
  } else if (rule["kind"] == "cavity") {
    Result<ParameterField> cavity =
        cavity_mask(height_mm, {.mm_per_pixel = node_->mm_per_pixel(),
                                .radius_mm = rule.value("radius_mm", kMaskRadius_mm),
                                .range_mm = rule.value("range_mm", 0.0),
                                .is_tile = node_->is_tile,
                                .threads = threads_});
    if (!cavity) return cavity;
    mask = std::move(*cavity);
    // Deep is full, and what lies level has none.
    levels = {.zero = 0.5, .one = 0};
  } else {
    mask = height_mask(height_mm, rule["at_mm"].get<double>(), rule.value("soft_mm", 0.0));
  }
  if (rule.contains("levels")) levels = {rule["levels"][0].get<double>(), rule["levels"][1].get<double>()};
  if (Result<void> ok = level(mask, levels); !ok) {
    Error error = std::move(ok).error();
    error.kind = ErrorKind::kBadData;
    error.where = found->second.from + ": " + key;
    return error;
  }
  return mask;
}

Result<void> MaterialStack::find_masks() {
  Result<ParameterField> height_mm = own(kHeight);
  if (!height_mm) return std::move(height_mm).error();
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    Result<ParameterField> mask = mask_of(i, *height_mm);
    if (!mask) return std::move(mask).error();
    masks_.push_back(std::move(*mask));
    if (Result<void> ok = lay_layer(i, kHeight, *height_mm); !ok) return ok;
  }
  return {};
}

Result<ParameterField> MaterialStack::composed(Parameter parameter) const {
  Result<ParameterField> field = own(parameter);
  if (!field) return field;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    if (Result<void> ok = lay_layer(i, parameter, *field); !ok) return std::move(ok).error();
  }
  if (Result<void> ok = put_over(parameter, *field); !ok) return std::move(ok).error();
  return field;
}

std::string MaterialStack::source(Parameter parameter) const {
  const char* name = facts_of(parameter).name;
  const auto of_table = [&](const std::string& table) {
    const auto map = node_->maps.find(table + "." + name);
    return map == node_->maps.end() ? std::string("assumed") : map->second.source;
  };
  if (has(node_->material.over, parameter)) return of_table("over");
  std::string source = of_table("surface");
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    if (!changes(i, parameter)) continue;
    const std::string layer = built_source(layers_[i], parameter);
    if (layer != "assumed" || source != "assumed") source = "derived";
  }
  return source;
}

Result<ParameterField> MaterialStack::weights() const {
  const auto map = node_->maps.find("runtime.weights");
  if (map == node_->maps.end()) return ParameterField{};
  Image<float> planes(node_->size, kMostRuntimeLayers);
  const std::string where = node_->material.runtime.at("weights").from + ": runtime.weights";
  const std::size_t count = node_->runtime.size();
  for (std::size_t p = 0; p < count; ++p) {
    Result<ParameterField> plane = read_mask(map->second, p, where);
    if (!plane) return plane;
    ParameterField fit = stretched(*plane, node_->size, node_->is_tile, threads_);
    clamp_to(fit, 0, 1);
    for (int y = 0; y < node_->size.height; ++y) {
      for (int x = 0; x < node_->size.width; ++x)
        planes(x, y, static_cast<int>(p)) = static_cast<float>(fit.at(x, y));
    }
  }
  return ParameterField::of(std::move(planes));
}

}  // namespace weft::material
