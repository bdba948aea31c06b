// SPDX-License-Identifier: Apache-2.0
#include "exchange/u3m/u3m_front.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/image/color_spaces.h"
#include "exchange/image_kind.h"

namespace weft::exchange {

namespace {

Error unreadable(const std::string& parameter, const Texture& texture, const std::string& why,
                 const std::string& remedy) {
  return {ErrorKind::kBadData, "U3M cannot read a texture", parameter + ": " + texture.file, why, remedy};
}

/// Roughness and anisotropy of Disney's principled model: alphas are r^2 / q and r^2 q, q = sqrt(1 - 0.9 a).
struct PrincipledLobe {
  double roughness = 0, anisotropy = 0;
};

PrincipledLobe principled_lobe_of(const Alphas& alphas) {
  if (alphas.along <= 0) return {};
  const double ratio = std::clamp(alphas.across / alphas.along, 0.1, 1.0);
  return {std::pow(alphas.along * alphas.across, 0.25), (1 - ratio) / 0.9};
}

Json constant_color(const std::array<double, 3>& linear) {
  const Rgb display = srgb_of_rec709({linear[0], linear[1], linear[2]});
  Json color;
  for (std::size_t i = 0; i < 3; ++i) {
    color[std::string(1, "rgb"[i])] = std::clamp(static_cast<double>(display[i]), 0.0, 1.0);
  }
  return color;
}

class FrontWriter {
 public:
  FrontWriter(const TexturedMaterial& material, Document& document)
      : material_(material), document_(document) {}

  Result<Json> write() {
    put_lobe();
    put_scalar("alpha", material_.opacity, "opacity", 1);
    put_scalar("metalness", material_.metallic, "metallic", 0);
    put_scalar("displacement", material_.height_mm, "height_mm", 0);
    put_normal();
    put_reflectance();
    put_sheen();
    put_base();
    put_absent();
    if (error_) return *error_;
    Json ordered;
    for (const char* member : {"alpha",
                               "anisotropy_value",
                               "anisotropy_rotation",
                               "clearcoat_value",
                               "clearcoat_normal",
                               "clearcoat_roughness",
                               "ior",
                               "metalness",
                               "normal",
                               "displacement",
                               "roughness",
                               "sheen_value",
                               "sheen_tint",
                               "specular_value",
                               "specular_tint",
                               "subsurface_radius",
                               "subsurface_value",
                               "transmission",
                               "basecolor",
                               "subsurface_color",
                               "shader",
                               "preview"}) {
      ordered[member] = front_[member];
    }
    return ordered;
  }

 private:
  void fail(Error error) {
    if (!error_) error_ = std::move(error);
  }

  Json image(const std::string& parameter, const Texture& texture, bool is_grey) {
    const auto kind = kind_of_file_name(texture.file);
    if (!kind || *kind == ImageKind::kExr || texture.bits > 16) {
      fail(unreadable(parameter, texture, "U3M has PNG, JPEG and TIFF of 8 or 16 bits", "write it as PNG"));
    }
    if (is_grey) check_grey(parameter, texture);
    if (std::ranges::find(document_.files, texture.file) == document_.files.end()) {
      document_.files.push_back(texture.file);
    }
    const auto& size_mm = *material_.size_mm;
    return {
        {"path", texture.file},
        {"width", size_mm[0]},
        {"height", size_mm[1]},
        {"dpi",
         {{"x", texture.size.width / (size_mm[0] / 25.4)}, {"y", texture.size.height / (size_mm[1] / 25.4)}}},
        {"repeat", {{"mode", "normal"}, {"rotation", 0}}}};
  }

  /// A reader takes the mean of all channels.
  void check_grey(const std::string& parameter, const Texture& texture) {
    const auto textures = textures_of(material_);
    const bool is_shared = std::ranges::any_of(textures, [&](const Texture* other) {
      return other->file == texture.file && other->channels != texture.channels;
    });
    if (texture.channels == "r" && !is_shared) return;
    fail(unreadable(parameter, texture,
                    "it shares a file with others, and U3M takes the mean of all channels",
                    "write a grey image for it"));
  }

  static Json number(double constant) { return {{"constant", constant}, {"texture", nullptr}}; }

  void put_scalar(const char* member, const std::optional<Parameter>& parameter, const char* name,
                  double otherwise, double scale = 1) {
    Json entry = number(parameter ? parameter->constant[0] * scale : otherwise);
    if (parameter && parameter->texture) {
      const Texture& texture = *parameter->texture;
      entry["texture"] = {{"factor", texture.scale * scale},
                          {"offset", texture.offset * scale},
                          {"image", image(name, texture, true)}};
    }
    front_[member] = entry;
  }

  void put_lobe() {
    const double roughness = material_.roughness ? material_.roughness->constant[0] : 0.7;
    const double strength = material_.anisotropy ? material_.anisotropy->constant[0] : 0;
    const PrincipledLobe lobe = principled_lobe_of(alphas_of(roughness, strength));
    const double scale = roughness > 0 && strength > 0 ? lobe.roughness / roughness : 1;
    put_scalar("roughness", material_.roughness, "roughness", 0.7, scale);
    front_["anisotropy_value"] = number(strength > 0 ? lobe.anisotropy : 0);
    double turns = 0;
    if (const auto& direction = material_.anisotropy_direction; direction && strength > 0) {
      turns = std::atan2(direction->constant[1], direction->constant[0]) / (2 * std::numbers::pi);
      if (turns < 0) turns += 1;
    }
    front_["anisotropy_rotation"] = number(turns);
    const bool has_maps = (material_.anisotropy && material_.anisotropy->texture) ||
                          (material_.anisotropy_direction && material_.anisotropy_direction->texture);
    if (has_maps) {
      document_.left_out.push_back(
          "anisotropy: its means stand for its maps, since U3M has another convention for each");
    }
    if (material_.occlusion) document_.left_out.push_back("occlusion: U3M has none");
  }

  void put_normal() {
    std::array<double, 3> mean = {0, 0, 1};
    Json entry;
    if (material_.normal) {
      mean = material_.normal->constant;
      const double length = std::hypot(mean[0], mean[1], mean[2]);
      for (double& each : mean) each /= length;
    }
    entry["constant"] = {{"x", mean[0]}, {"y", mean[1]}, {"z", mean[2]}};
    entry["texture"] = nullptr;
    if (material_.normal && material_.normal->texture) {
      entry["texture"] = {{"scale", 1.0}, {"image", image("normal", *material_.normal->texture, false)}};
    }
    front_["normal"] = entry;
  }

  /// specular_value 1 is a reflectance of 8 %.
  void put_reflectance() {
    const auto& f0 = material_.f0;
    const double mean = f0 ? f0->constant[0] : 0.04;
    front_["ior"] = number(ior_of_f0(mean));
    put_scalar("specular_value", f0, "f0", 0.5, 1 / 0.08);
  }

  /// Disney's sheen is white or has the hue of the base colour: the tint that is nearest.
  void put_sheen() {
    double value = 0, tint = 0;
    if (material_.sheen_color) {
      const auto& sheen = material_.sheen_color->constant;
      const auto& base = material_.base_color.constant;
      const double sheen_mean = (sheen[0] + sheen[1] + sheen[2]) / 3;
      const double base_mean = (base[0] + base[1] + base[2]) / 3;
      double dot = 0, square = 0;
      for (std::size_t i = 0; sheen_mean > 0 && base_mean > 0 && i < 3; ++i) {
        const double hue = base[i] / base_mean - 1;
        dot += hue * (sheen[i] / sheen_mean - 1);
        square += hue * hue;
      }
      value = sheen_mean;
      tint = square > 1e-9 ? std::clamp(dot / square, 0.0, 1.0) : 0;
      document_.left_out.push_back(
          "sheen: U3M has a strength and a tint, so the mean of its colour stands for it, without roughness");
    }
    front_["sheen_value"] = number(value);
    front_["sheen_tint"] = number(tint);
  }

  void put_base() {
    const Parameter& color = material_.base_color;
    Json entry = {{"constant", constant_color(color.constant)}, {"texture", nullptr}};
    if (color.texture) {
      const Texture& texture = *color.texture;
      if (!texture.is_srgb || texture.scale != 1 || texture.offset != 0) {
        fail(unreadable("base_color", texture, "U3M's colours are in sRGB, without scale and offset",
                        "write it so"));
      }
      entry["texture"] = {{"mode", "multiply"},
                          {"factor", constant_color({1, 1, 1})},
                          {"image", image("base_color", texture, false)}};
    }
    front_["basecolor"] = entry;
  }

  void put_absent() {
    for (const char* member : {"clearcoat_value", "clearcoat_roughness", "specular_tint", "subsurface_radius",
                               "subsurface_value", "transmission"}) {
      front_[member] = number(0);
    }
    front_["clearcoat_normal"] = {{"constant", {{"x", 0}, {"y", 0}, {"z", 1}}}, {"texture", nullptr}};
    front_["subsurface_color"] = {{"constant", constant_color({1, 1, 1})}, {"texture", nullptr}};
    front_["shader"] = "principled";
    front_["preview"] = nullptr;
  }

  const TexturedMaterial& material_;
  Document& document_;
  Json front_;
  std::optional<Error> error_;
};

}  // namespace

Result<Json> u3m_front_of(const TexturedMaterial& material, Document& document) {
  return FrontWriter(material, document).write();
}

}  // namespace weft::exchange
