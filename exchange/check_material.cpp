// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <string_view>

#include "exchange/document.h"

namespace weft::exchange {

namespace {

enum class Shape { kScalar, kColor, kNormal, kDirection };

/// What a parameter may be.
struct Rule {
  const char* name;
  Shape shape;
  double least, most;
};

constexpr double kSlack = 1e-9;  // of ends of ranges that were computed

Error bad_parameter(const Rule& rule, const std::string& why, const std::string& remedy) {
  return {ErrorKind::kBadData, "a parameter of the material cannot be written", rule.name, why, remedy};
}

bool is_within(double value, const Rule& rule) {
  return std::isfinite(value) && value >= rule.least - kSlack && value <= rule.most + kSlack;
}

Result<void> check_constant(const TexturedParameter& parameter, const Rule& rule) {
  const auto& c = parameter.constant;
  const std::size_t count = rule.shape == Shape::kScalar ? 1 : rule.shape == Shape::kDirection ? 2 : 3;
  for (std::size_t i = 0; i < count; ++i) {
    if (is_within(c[i], rule)) continue;
    return bad_parameter(rule,
                         "its constant " + number_text(c[i]) + " is not within " + number_text(rule.least) +
                             " and " + number_text(rule.most),
                         "give its mean in the linear unit of the parameter");
  }
  const bool must_have_length =
      rule.shape == Shape::kNormal || (rule.shape == Shape::kDirection && !parameter.texture);
  if (must_have_length && std::hypot(c[0], c[1], count == 3 ? c[2] : 0) < 1e-6) {
    return bad_parameter(rule, "its constant has no length", "give its mean direction");
  }
  return {};
}

bool has_fitting_channels(const Texture& texture, Shape shape) {
  const std::string& channels = texture.channels;
  if (shape == Shape::kDirection) return channels == "rg";
  if (shape != Shape::kScalar) return channels == "rgb";
  return channels == "r" || channels == "g" || channels == "b" || channels == "a";
}

Result<void> check_texture(const Texture& texture, const Rule& rule) {
  if (const auto path = check_portable_path(texture.file); !path) {
    return bad_parameter(rule, path.error().why + ": " + texture.file, path.error().remedy);
  }
  if (texture.size.width < 1 || texture.size.height < 1) {
    return bad_parameter(rule, "its texture " + texture.file + " has no pixels", "give its size in pixels");
  }
  if (texture.bits != 8 && texture.bits != 16 && texture.bits != 32) {
    return bad_parameter(rule, "its texture has " + std::to_string(texture.bits) + " bits a channel",
                         "write it with 8, 16 or 32");
  }
  if (!has_fitting_channels(texture, rule.shape)) {
    return bad_parameter(rule, "it does not stand in the channels '" + texture.channels + "' of a file",
                         "give a colour or a normal all of rgb, a direction rg, a number one channel");
  }
  if (texture.is_srgb && rule.shape != Shape::kColor) {
    return bad_parameter(rule, "its texture is said to be in sRGB, and it is no colour", "write it linear");
  }
  const bool is_vector = rule.shape == Shape::kNormal || rule.shape == Shape::kDirection;
  const bool is_plain = texture.scale == 1 && texture.offset == 0;
  const bool fits = is_within(texture.offset, rule) && is_within(texture.scale + texture.offset, rule);
  if (is_vector ? !is_plain : !fits) {
    return bad_parameter(rule,
                         "scale " + number_text(texture.scale) + " and offset " +
                             number_text(texture.offset) + " take texels out of its range",
                         is_vector ? "keep scale 1 and offset 0" : "choose them so that texels stay inside");
  }
  return {};
}

Result<void> check_parameter(const TexturedParameter& parameter, const Rule& rule) {
  if (auto constant = check_constant(parameter, rule); !constant) return constant;
  return parameter.texture ? check_texture(*parameter.texture, rule) : Result<void>();
}

Result<void> check_texts(const TexturedMaterial& material) {
  if (material.name.empty() || !is_plain_text(material.name)) {
    return Error{ErrorKind::kBadData, "the material's name cannot be written", "name",
                 material.name.empty() ? "it is empty" : "it is no UTF-8, or has control characters",
                 "name the cloth"};
  }
  for (const auto& [key, value] : material.provenance) {
    if (!key.empty() && is_plain_text(key) && is_plain_text(value)) continue;
    return Error{ErrorKind::kBadData, "the provenance cannot be written", is_plain_text(key) ? key : "key",
                 "it is no UTF-8, has control characters, or has no key", "correct the session's metadata"};
  }
  return {};
}

}  // namespace

Result<void> check_material(const TexturedMaterial& material) {
  if (auto texts = check_texts(material); !texts) return texts;
  if (material.size_mm) {
    for (const double side_mm : *material.size_mm) {
      if (std::isfinite(side_mm) && side_mm > 1e-3 && side_mm < 1e6) continue;
      return Error{ErrorKind::kBadData, "the material's size cannot be", "size_mm",
                   number_text(side_mm) + " mm is not between 0.001 and 1000000",
                   "leave the size out where it is not known"};
    }
  }
  const Rule color = {"base_color", Shape::kColor, 0, 1};
  if (auto checked = check_parameter(material.base_color, color); !checked) return checked;
  const std::array<std::pair<const std::optional<TexturedParameter>*, Rule>, 11> rules = {{
      {&material.normal, {"normal", Shape::kNormal, -1, 1}},
      {&material.height_mm, {"height_mm", Shape::kScalar, -1e6, 1e6}},
      {&material.roughness, {"roughness", Shape::kScalar, 0, 1}},
      {&material.occlusion, {"occlusion", Shape::kScalar, 0, 1}},
      {&material.opacity, {"opacity", Shape::kScalar, 0, 1}},
      {&material.f0, {"f0", Shape::kScalar, 0, 1}},
      {&material.metallic, {"metallic", Shape::kScalar, 0, 1}},
      {&material.anisotropy, {"anisotropy", Shape::kScalar, 0, 1}},
      {&material.anisotropy_direction, {"anisotropy_direction", Shape::kDirection, -1, 1}},
      {&material.sheen_color, {"sheen_color", Shape::kColor, 0, 1}},
      {&material.sheen_roughness, {"sheen_roughness", Shape::kScalar, 0, 1}},
  }};
  for (const auto& [parameter, rule] : rules) {
    if (!*parameter) continue;
    if (auto checked = check_parameter(**parameter, rule); !checked) return checked;
  }
  return {};
}

}  // namespace weft::exchange
