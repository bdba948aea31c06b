// SPDX-License-Identifier: Apache-2.0
#include "exchange/u3m/u3m.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/iso_time.h"
#include "core/base/json_document.h"
#include "core/image/color_spaces.h"
#include "exchange/image_kind.h"
#include "exchange/u3m/vocabulary.h"

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

  void put_scalar(const char* member, const std::optional<TexturedParameter>& parameter, const char* name,
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
    const TexturedParameter& color = material_.base_color;
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

// U3M's "visualisation" of a material whose size is known; files and what is left out are added to
// `document`.
Result<Json> u3m_front_of(const TexturedMaterial& material, Document& document) {
  return FrontWriter(material, document).write();
}

Error bad_u3m(const std::string& where, const std::string& why, const std::string& remedy) {
  return {ErrorKind::kBadData, "the U3M document cannot be written", where, why, remedy};
}

bool is_sha256(std::string_view text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

bool is_utf8_text(const std::string& text) {
  std::string flat = text;
  std::ranges::replace(flat, '\n', ' ');
  return is_plain_text(flat);
}

Result<std::string> utc_of(const char* where, const std::string& time) {
  const auto seconds = seconds_of_iso_time(time);
  if (!seconds || *seconds < 0) {
    return bad_u3m(where, "'" + time + "' is no time like 2026-11-21T14:25:01Z", "give one of the session");
  }
  return iso_time(*seconds);
}

Result<void> check_options(const TexturedMaterial& material, const U3mOptions& options) {
  if (!material.size_mm) {
    return bad_u3m("size_mm", "U3M is in millimetres, and the size of the cloth is not known",
                   "scan with a calibrated rig, or choose a format without sizes");
  }
  if (!is_sha256(options.digest)) {
    return bad_u3m("digest", "it is no SHA-256 of 64 hexadecimal digits",
                   "hash what the document is made of");
  }
  if (!is_utf8_text(options.description)) {
    return bad_u3m("description", "it is no UTF-8, or has control characters", "correct the notes");
  }
  const auto is_amount = [](const std::optional<double>& amount) {
    return !amount || (std::isfinite(*amount) && *amount >= 0);
  };
  if (!is_amount(options.physics.thickness_mm)) {
    return bad_u3m("thickness_mm", "it is below 0 or no number", "correct the metadata");
  }
  if (!is_amount(options.physics.weight_g_m2)) {
    return bad_u3m("weight_g_m2", "it is below 0 or no number", "correct the metadata");
  }
  double sum = 0;
  for (const FibrePart& part : options.physics.composition) {
    const bool is_share = std::isfinite(part.share) && part.share >= 0 && part.share <= 1;
    if (!is_share || !is_plain_text(part.fibre)) {
      return bad_u3m("composition", "the share of '" + part.fibre + "' is not within 0 and 1",
                     "correct the metadata");
    }
    sum += part.share;
  }
  if (!options.physics.composition.empty() && std::abs(sum - 1) > 1e-6) {
    return bad_u3m("composition", "its shares have the sum " + number_text(sum), "correct the metadata");
  }
  if (!is_plain_text(options.physics.construction)) {
    return bad_u3m("construction", "it is no UTF-8, or has control characters", "correct the metadata");
  }
  return {};
}

/// A word of a closed list, or "other" with the words themselves.
Json typed(const std::optional<std::string>& word, const std::string& words) {
  if (word) return {{"type", *word}, {"name", nullptr}};
  return {{"type", "other"}, {"name", words}};
}

Json physics_of(const U3mPhysics& physics) {
  const auto amount = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  Json document = {{"thickness", amount(physics.thickness_mm)},
                   {"weight", amount(physics.weight_g_m2)},
                   {"composition", nullptr},
                   {"devices", {{"fab", "null"}}},  // the schema's word for none
                   {"material_type", nullptr},
                   {"construction", nullptr}};
  if (!physics.composition.empty()) {
    Json parts = Json::array();
    for (const FibrePart& part : physics.composition) {
      Json entry = typed(u3m_fibre(part.fibre), part.fibre);
      parts.push_back({{"ratio", part.share}, {"type", entry["type"]}, {"name", entry["name"]}});
    }
    document["composition"] = {{"parts", parts}};
  }
  if (!physics.construction.empty()) {
    const auto word = u3m_construction(physics.construction);
    document["construction"] = typed(word, physics.construction);
    const std::string type(word ? u3m_material_type_of(*word) : "");
    if (!type.empty()) document["material_type"] = typed(type, type);
  }
  return document;
}

bool is_known(const U3mPhysics& physics) {
  return physics.thickness_mm || physics.weight_g_m2 || !physics.composition.empty() ||
         !physics.construction.empty();
}

}  // namespace

std::string uuid_of(std::string_view sha256) {
  std::string digits(sha256.substr(0, 32));
  digits.resize(32, '0');
  digits[12] = '4';
  const std::size_t nibble = std::string_view("0123456789abcdef").find(digits[16]);
  digits[16] = "89ab"[nibble % 4];
  for (const std::size_t at : {20u, 16u, 12u, 8u}) digits.insert(at, 1, '-');
  return digits;
}

Result<Document> u3m_of(const TexturedMaterial& material, const U3mOptions& options) {
  if (auto checked = check_material(material); !checked) return checked.error();
  if (auto checked = check_options(material, options); !checked) return checked.error();
  const auto created = utc_of("created", options.created);
  if (!created) return created.error();
  const auto modified = utc_of("modified", options.modified);
  if (!modified) return modified.error();
  Document document;
  const auto front = u3m_front_of(material, document);
  if (!front) return front.error();

  Json provenance = Json::object();
  for (const auto& [key, value] : material.provenance) provenance[key] = value;
  Json asset = {{"id", uuid_of(options.digest)},
                {"name", material.name},
                {"description", options.description},
                {"created", *created},
                {"modified", *modified},
                {"front", *front},
                {"back", nullptr},
                {"side", nullptr},
                {"physics", is_known(options.physics) ? physics_of(options.physics) : Json()},
                {"metadata", nullptr}};
  Json own = {{"size_mm", *material.size_mm}, {"provenance", provenance}};
  if (!material.is_size_known) own["size_known"] = false;
  const Json root = {{"schema", "1.1"}, {"material", asset}, {"custom", {{"weft", std::move(own)}}}};
  document.bytes = root.dump(1) + "\n";
  return document;
}

}  // namespace weft::exchange
