// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/base/iso_time.h"
#include "core/base/json_document.h"
#include "exchange/u3m/u3m.h"
#include "exchange/u3m/vocabulary.h"
#include "tests/exchange/export_checks.h"

namespace weft::exchange {

namespace {

using Words = std::span<const std::string_view>;

/// A number from `least` to `most`.
struct Interval {
  double least, most;
};
constexpr Interval kAny = {-1e300, 1e300}, kShare = {0, 1}, kPositive = {0, 1e300};

class U3mChecker {
 public:
  explicit U3mChecker(const std::map<std::string, Size, std::less<>>& pixels_of) : pixels_of_(pixels_of) {}

  Result<void> check(const Json& root) {
    if (has_members(root, "", {"schema", "material", "custom"})) {
      if (root["schema"] != "1.1") fail("/schema", "it is not 1.1");
      if (!root["custom"].is_object() && !root["custom"].is_null()) fail("/custom", "it is no object");
      check_material_part(root["material"], "/material");
    }
    return error_ ? Result<void>(*error_) : Result<void>();
  }

 private:
  void fail(const std::string& where, const std::string& why) {
    if (error_) return;
    error_ = Error{ErrorKind::kBadData, "the document is not as U3M 1.1 asks", where, why,
                   "write it again with weft export"};
  }

  /// An object with exactly these members.
  bool has_members(const Json& object, const std::string& where, std::initializer_list<const char*> names) {
    if (!object.is_object()) {
      fail(where, "it is no object");
      return false;
    }
    for (const char* name : names) {
      if (object.contains(name)) continue;
      fail(where + "/" + name, "it is missing");
      return false;
    }
    if (object.size() == names.size()) return true;
    for (const auto& [key, value] : object.items()) {
      const auto is_it = [&key = key](const char* name) { return key == name; };
      if (std::ranges::none_of(names, is_it)) fail(where + "/" + key, "the schema does not know it");
    }
    return false;
  }

  void check_number(const Json& value, const std::string& where, Interval interval) {
    const bool fits = value.is_number() && std::isfinite(value.get<double>()) &&
                      value.get<double>() >= interval.least && value.get<double>() <= interval.most;
    if (!fits) {
      fail(where,
           "it is no number from " + number_text(interval.least) + " to " + number_text(interval.most));
    }
  }

  void check_optional_number(const Json& value, const std::string& where) {
    if (!value.is_null()) check_number(value, where, kPositive);
  }

  void check_numbers(const Json& object, const std::string& where, std::initializer_list<const char*> names,
                     Interval interval) {
    if (!has_members(object, where, names)) return;
    for (const char* name : names) check_number(object[name], where + "/" + name, interval);
  }

  void check_material_part(const Json& material, const std::string& where) {
    if (!has_members(material, where,
                     {"name", "id", "created", "modified", "front", "back", "side", "physics", "metadata",
                      "description"})) {
      return;
    }
    for (const char* name : {"name", "id", "created", "modified", "description"}) {
      if (!material[name].is_string()) return fail(where + "/" + name, "it is no text");
    }
    if (material["name"] == "") fail(where + "/name", "it is empty");
    check_id(material["id"].get<std::string>(), where + "/id");
    for (const char* name : {"created", "modified"}) {
      const auto time = material[name].get<std::string>();
      const bool has_zone = time.size() > 19 && (time.back() == 'Z' || time[time.size() - 3] == ':');
      if (!seconds_of_iso_time(time) || !has_zone) fail(where + "/" + name, "it is no time with a zone");
    }
    bool has_any = !material["physics"].is_null();
    for (const char* side : {"front", "back", "side"}) {
      if (material[side].is_null()) continue;
      has_any = true;
      check_visualisation(material[side], where + "/" + side);
    }
    if (!has_any) fail(where, "it has neither a side nor physics");
    if (!material["physics"].is_null()) check_physics(material["physics"], where + "/physics");
    const Json& metadata = material["metadata"];
    if (!metadata.is_null() && !metadata.is_object()) fail(where + "/metadata", "it is no object");
  }

  void check_id(std::string id, const std::string& where) {
    if (id.size() == 38 && id.front() == '{' && id.back() == '}') id = id.substr(1, 36);
    bool fits = id.size() == 36 && id[14] == '4';
    for (std::size_t i = 0; fits && i < 36; ++i) {
      const bool is_dash = i == 8 || i == 13 || i == 18 || i == 23;
      const std::string_view allowed = is_dash ? "-" : i == 19 ? "89abAB" : "0123456789abcdefABCDEF";
      fits = allowed.find(id[i]) != std::string_view::npos;
    }
    if (!fits) fail(where, "it is no UUID of version 4");
  }

  void check_visualisation(const Json& side, const std::string& where) {
    if (!has_members(side, where,
                     {"alpha",
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
                      "preview"})) {
      return;
    }
    for (const char* name : {"alpha", "anisotropy_rotation", "metalness", "transmission"}) {
      check_scalar(side[name], where + "/" + name, kShare);
    }
    for (const char* name : {"anisotropy_value", "clearcoat_value", "clearcoat_roughness", "ior",
                             "displacement", "roughness", "sheen_value", "sheen_tint", "specular_value",
                             "specular_tint", "subsurface_radius", "subsurface_value"}) {
      check_scalar(side[name], where + "/" + name, kAny);
    }
    for (const char* name : {"normal", "clearcoat_normal"}) check_normal(side[name], where + "/" + name);
    for (const char* name : {"basecolor", "subsurface_color"}) check_color(side[name], where + "/" + name);
    if (side["shader"] != "principled") fail(where + "/shader", "it is not principled");
    if (const Json& preview = side["preview"]; !preview.is_null()) {
      if (has_members(preview, where + "/preview", {"dpi", "path", "width", "height"})) {
        check_size(preview, where + "/preview");
      }
    }
  }

  void check_scalar(const Json& entry, const std::string& where, Interval interval) {
    if (!has_members(entry, where, {"constant", "texture"})) return;
    check_number(entry["constant"], where + "/constant", interval);
    const Json& texture = entry["texture"];
    if (texture.is_null() || !has_members(texture, where + "/texture", {"factor", "offset", "image"})) return;
    check_number(texture["factor"], where + "/texture/factor", kAny);
    check_number(texture["offset"], where + "/texture/offset", kAny);
    check_image(texture["image"], where + "/texture/image");
  }

  void check_normal(const Json& entry, const std::string& where) {
    if (!has_members(entry, where, {"constant", "texture"})) return;
    check_numbers(entry["constant"], where + "/constant", {"x", "y", "z"}, {-1, 1});
    const Json& texture = entry["texture"];
    if (texture.is_null() || !has_members(texture, where + "/texture", {"scale", "image"})) return;
    check_number(texture["scale"], where + "/texture/scale", kAny);
    check_image(texture["image"], where + "/texture/image");
  }

  void check_color(const Json& entry, const std::string& where) {
    if (!has_members(entry, where, {"constant", "texture"})) return;
    check_numbers(entry["constant"], where + "/constant", {"r", "g", "b"}, kShare);
    const Json& texture = entry["texture"];
    if (texture.is_null() || !has_members(texture, where + "/texture", {"mode", "factor", "image"})) return;
    static constexpr std::array<std::string_view, 7> kModes = {"add", "subtract", "multiply", "divide",
                                                               "max", "min",      "overlay"};
    check_word(texture["mode"], where + "/texture/mode", kModes);
    check_numbers(texture["factor"], where + "/texture/factor", {"r", "g", "b"}, kShare);
    check_image(texture["image"], where + "/texture/image");
  }

  void check_word(const Json& value, const std::string& where, Words words) {
    const bool is_known =
        value.is_string() && std::ranges::find(words, value.get<std::string>()) != words.end();
    if (!is_known) fail(where, "it is no word of the list");
  }

  void check_image(const Json& image, const std::string& where) {
    if (!has_members(image, where, {"repeat", "dpi", "path", "width", "height"})) return;
    if (has_members(image["repeat"], where + "/repeat", {"rotation", "mode"})) {
      static constexpr std::array<std::string_view, 4> kModes = {"normal", "mirror_x", "mirror_y",
                                                                 "mirror_xy"};
      check_number(image["repeat"]["rotation"], where + "/repeat/rotation", kAny);
      check_word(image["repeat"]["mode"], where + "/repeat/mode", kModes);
    }
    check_size(image, where);
  }

  /// Path, millimetres and dpi, which repeat what the file's pixels say.
  void check_size(const Json& image, const std::string& where) {
    check_number(image["width"], where + "/width", kPositive);
    check_number(image["height"], where + "/height", kPositive);
    check_numbers(image["dpi"], where + "/dpi", {"x", "y"}, kPositive);
    const Json& path = image["path"];
    if (!path.is_string() || !check_portable_path(path.get<std::string>())) {
      fail(where + "/path", "it is no portable relative path");
    }
    if (error_) return;
    const auto pixels = pixels_of_.find(path.get<std::string>());
    if (pixels == pixels_of_.end()) return;
    const auto check_side = [&](const char* side, const char* axis, int count) {
      const double told = image["dpi"][axis].get<double>() * image[side].get<double>() / 25.4;
      if (std::abs(told - count) <= 1e-6 * count) return;
      fail(where + "/dpi/" + axis, "dpi and " + std::string(side) + " make " + number_text(told) +
                                       " pixels, the file has " + std::to_string(count));
    };
    check_side("width", "x", pixels->second.width);
    check_side("height", "y", pixels->second.height);
  }

  /// "type" of a list, with "name" where that is "other" and nowhere else.
  void check_typed(const Json& entry, const std::string& where, Words words) {
    const Json& type = entry["type"];
    const Json& name = entry["name"];
    if (type == "other") {
      if (!name.is_string()) fail(where + "/name", "'other' needs a name");
      return;
    }
    if (type != "unknown") check_word(type, where + "/type", words);
    if (!name.is_null()) fail(where + "/name", "only 'other' has a name");
  }

  void check_physics(const Json& physics, const std::string& where) {
    if (!has_members(physics, where,
                     {"thickness", "weight", "composition", "devices", "material_type", "construction"})) {
      return;
    }
    check_optional_number(physics["thickness"], where + "/thickness");
    check_optional_number(physics["weight"], where + "/weight");
    if (has_members(physics["devices"], where + "/devices", {"fab"}) &&
        !physics["devices"]["fab"].is_string()) {
      fail(where + "/devices/fab", "it is no text");
    }
    for (const auto& [key, words] :
         {std::pair("material_type", u3m_material_types()), {"construction", u3m_constructions()}}) {
      const Json& entry = physics[key];
      if (entry.is_null() || !has_members(entry, where + "/" + key, {"type", "name"})) continue;
      check_typed(entry, where + "/" + key, words);
    }
    if (!physics["composition"].is_null()) check_composition(physics["composition"], where + "/composition");
  }

  void check_composition(const Json& composition, const std::string& where) {
    if (!has_members(composition, where, {"parts"})) return;
    const Json& parts = composition["parts"];
    if (!parts.is_array() || parts.empty()) return fail(where + "/parts", "it has no part");
    double sum = 0;
    for (std::size_t i = 0; i < parts.size() && !error_; ++i) {
      const std::string here = where + "/parts/" + std::to_string(i);
      if (!has_members(parts[i], here, {"ratio", "type", "name"})) return;
      check_number(parts[i]["ratio"], here + "/ratio", kShare);
      check_typed(parts[i], here, u3m_fibres());
      if (!error_) sum += parts[i]["ratio"].get<double>();
    }
    if (!error_ && std::abs(sum - 1) > 1e-6) {
      fail(where + "/parts", "the sum of ratios is " + number_text(sum));
    }
  }

  const std::map<std::string, Size, std::less<>>& pixels_of_;
  std::optional<Error> error_;
};

}  // namespace

Result<void> check_u3m(std::string_view text, const std::map<std::string, Size, std::less<>>& pixels_of) {
  const Json root = Json::parse(text, nullptr, false);
  if (root.is_discarded()) {
    return Error{ErrorKind::kBadData, "the document is not as U3M 1.1 asks", "", "it is no JSON",
                 "write it again with weft export"};
  }
  return U3mChecker(pixels_of).check(root);
}

}  // namespace weft::exchange
