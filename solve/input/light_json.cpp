// SPDX-License-Identifier: Apache-2.0
#include "solve/input/light_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "core/base/json_document.h"
#include "core/base/number.h"
#include "solve/input/light_text.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

using Triple = std::array<double, 3>;

const Json kNothing;

const Json& member(const Json& object, const char* key) {
  if (!object.is_object()) return kNothing;
  const auto found = object.find(key);
  return found == object.end() ? kNothing : *found;
}

std::string text_in(const Json& object, const char* key) {
  const Json& value = member(object, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

// Three numbers: a list of them, or an object with these keys.
std::optional<Triple> triple_in(const Json& value, const std::array<const char*, 3>& keys) {
  if (value.is_array() && value.size() != 3) return std::nullopt;
  Triple triple = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const Json& number = value.is_array() ? value[i] : member(value, keys[i]);
    // Boost's property trees write numbers as texts.
    if (number.is_string()) {
      const std::optional<double> read = as_number(number.get_ref<const std::string&>());
      if (!read) return std::nullopt;
      triple[i] = *read;
    } else if (number.is_number()) {
      triple[i] = number.get<double>();
    } else {
      return std::nullopt;
    }
    if (!std::isfinite(triple[i])) return std::nullopt;
  }
  return triple;
}

Result<std::vector<Triple>> triples_in(const Json& list, const char* key,
                                       const std::array<const char*, 3>& keys, const fs::path& file) {
  std::vector<Triple> triples;
  if (!list.is_array()) return triples;
  for (const Json& each : list) {
    const std::optional<Triple> triple = triple_in(each, keys);
    if (!triple)
      return bad_lights(file, fmt::format("{}[{}] is not three finite numbers", key, triples.size()));
    triples.push_back(*triple);
  }
  return triples;
}

Vec3 vector_of(const Triple& t) {
  return {t[0], t[1], t[2]};
}

/// Which of the lists of a dome holds its lights.
struct DomeLights {
  std::vector<Triple> lights;
  bool are_positions = false;
};

Result<DomeLights> lights_of_dome(const Json& dome, const fs::path& file, std::vector<std::string>& assumed) {
  const std::string configuration = text_in(dome, "lightConfiguration");
  const auto read = [&](const char* key) {
    return triples_in(member(dome, key), key, {"x", "y", "z"}, file);
  };
  if (configuration == "spherical" || configuration == "lights3d") {
    for (const char* key : {configuration == "spherical" ? "positionsSphere" : "positions3d", "positions"}) {
      Result<std::vector<Triple>> positions = read(key);
      if (!positions) return std::move(positions).error();
      if (!positions->empty()) return DomeLights{std::move(*positions), true};
    }
    assumed.push_back(fmt::format("it is {} and has no positions: its directions are taken", configuration));
  }
  Result<std::vector<Triple>> directions = read("directions");
  if (!directions) return std::move(directions).error();
  return DomeLights{std::move(*directions), false};
}

// ledAdjust multiplies what a photograph shows.
Result<void> take_adjustments(const Json& dome, const fs::path& file, LightList& list) {
  const auto factors = triples_in(member(dome, "ledAdjust"), "ledAdjust", {"r", "g", "b"}, file);
  if (!factors) return factors.error();
  if (factors->empty()) return {};
  if (factors->size() != list.lights.size()) {
    return bad_lights(
        file, fmt::format("it has {} lights and {} in ledAdjust", list.lights.size(), factors->size()));
  }
  for (std::size_t k = 0; k < factors->size(); ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double factor = (*factors)[k][c];
      if (!(factor > 0) || !std::isfinite(1 / factor))
        return bad_lights(file, fmt::format("ledAdjust[{}] is not above 0", k));
      list.lights[k].strength_rgb[c] = 1 / factor;
    }
  }
  list.have_strengths = true;
  list.assumed.emplace_back("ledAdjust is taken as what photographs are multiplied by");
  return {};
}

// The names of a project's photographs; those that it skips go, with their lights.
Result<void> take_images(const Json& project, const fs::path& file, LightList& list) {
  const Json& images = member(project, "images");
  if (!images.is_array() || images.empty()) return {};
  const std::string folder = text_in(project, "folder");
  const auto is_skipped = [](const Json& image) { return member(image, "skip") == Json(true); };
  const auto skipped = static_cast<std::size_t>(std::ranges::count_if(images, is_skipped));
  const bool are_for_all = list.lights.size() == images.size();
  if (!are_for_all && list.lights.size() != images.size() - skipped) {
    return bad_lights(file, fmt::format("it has {} images, {} of them skipped, and {} lights", images.size(),
                                        skipped, list.lights.size()));
  }
  std::vector<ListedLight> lights;
  std::size_t next = 0;
  for (const Json& image : images) {
    if (is_skipped(image) && !are_for_all) continue;
    ListedLight light = list.lights[next++];
    if (is_skipped(image)) continue;
    const std::string name = text_in(image, "filename");
    if (name.empty()) return bad_lights(file, fmt::format("image {} has no filename", next));
    light.name = folder.empty() || folder == "." ? name : folder + "/" + name;
    lights.push_back(std::move(light));
  }
  list.lights = std::move(lights);
  if (skipped > 0)
    list.assumed.push_back(fmt::format("{} photographs that the project skips are left out", skipped));
  return {};
}

Result<LightList> read_relight(const Json& document, const fs::path& file) {
  const bool is_project = member(document, "dome").is_object() || member(document, "images").is_array();
  const Json& dome = is_project ? member(document, "dome") : document;
  LightList list = {.file = file, .kind = is_project ? "RelightLab project" : "RelightLab dome"};
  Result<DomeLights> lights = lights_of_dome(dome, file, list.assumed);
  if (!lights) return std::move(lights).error();
  // Early versions have them there.
  if (lights->lights.empty() && is_project) {
    for (const Json& image : member(document, "images")) {
      const auto direction = triple_in(member(image, "direction"), {"x", "y", "z"});
      if (direction) lights->lights.push_back(*direction);
    }
  }
  list.are_positions = lights->are_positions;
  for (const Triple& toward : lights->lights) list.lights.push_back({.toward = vector_of(toward)});
  if (Result<void> ok = take_adjustments(dome, file, list); !ok) return std::move(ok).error();
  if (Result<void> ok = take_images(document, file, list); !ok) return std::move(ok).error();
  return list;
}

Result<ListedLight> light_of_meshroom(const Json& entry, std::size_t k, const fs::path& file) {
  ListedLight light;
  const std::array<const char*, 3> no_keys = {"", "", ""};
  const std::optional<Triple> direction = triple_in(member(entry, "direction"), no_keys);
  if (!direction) {
    const bool is_harmonic = member(entry, "direction").is_array() && member(entry, "direction").size() == 9;
    return bad_lights(file, fmt::format("lights[{}] has {}", k,
                                        is_harmonic ? "spherical harmonics and not one direction"
                                                    : "no direction of three finite numbers"));
  }
  light.toward = {(*direction)[0], -(*direction)[1], -(*direction)[2]};
  const Json& intensity = member(entry, "intensity");
  if (!intensity.is_null()) {
    const std::optional<Triple> strength =
        triple_in(intensity.is_array() ? intensity : Json::array({intensity, intensity, intensity}), no_keys);
    if (!strength || !std::ranges::all_of(*strength, [](double v) { return v > 0; }))
      return bad_lights(file, fmt::format("lights[{}] has no intensity above 0", k));
    light.strength_rgb = *strength;
  }
  return light;
}

// A text or a whole number.
std::string number_of_view(const Json& entry) {
  const Json& view = member(entry, "viewId");
  return view.is_number_integer() ? view.dump() : text_in(entry, "viewId");
}

Result<LightList> read_meshroom(const Json& document, const fs::path& file) {
  LightList list = {.file = file, .kind = "lights of Meshroom"};
  const Json& lights = member(document, "lights");
  std::size_t k = 0;
  for (const auto& [key, entry] : lights.items()) {
    Result<ListedLight> light = light_of_meshroom(entry, k++, file);
    if (!light) return std::move(light).error();
    if (lights.is_object()) light->name = key;
    if (lights.is_array()) light->view = number_of_view(entry);
    list.have_strengths = list.have_strengths || !member(entry, "intensity").is_null();
    list.lights.push_back(std::move(*light));
  }
  list.assumed.emplace_back("y of Meshroom points down and z away: both are turned round");
  return list;
}

}  // namespace

Result<bool> name_views(std::string_view sfm, const fs::path& file, LightList& list) {
  const ParsedJson parsed = parse_json(sfm);
  const Json& views = member(parsed.document, "views");
  if (!parsed.why.empty() || !views.is_array())
    return bad_lights(file,
                      parsed.why.empty() ? "it has no list of views, as a .sfm of Meshroom has" : parsed.why);
  std::map<std::string, std::string> paths;
  for (const Json& view : views) paths[number_of_view(view)] = text_in(view, "path");
  std::vector<std::string> names;
  for (const ListedLight& light : list.lights) {
    const auto path = paths.find(light.view);
    if (light.view.empty() || path == paths.end() || path->second.empty()) return false;
    names.push_back(path->second);
  }
  for (std::size_t k = 0; k < names.size(); ++k) list.lights[k].name = std::move(names[k]);
  return true;
}

bool is_light_json(std::string_view text) {
  const Json document = parse_json(text).document;
  if (member(document, "dome").is_object() || member(document, "directions").is_array()) return true;
  const Json& lights = member(document, "lights");
  return lights.is_structured() && !lights.empty() && !member(*lights.begin(), "direction").is_null();
}

Result<LightList> read_light_json(std::string_view text, const fs::path& file) {
  const ParsedJson parsed = parse_json(text);
  if (!parsed.why.empty()) return bad_lights(file, parsed.why);
  const Json& document = parsed.document;
  if (member(document, "lights").is_structured()) return read_meshroom(document, file);
  if (member(document, "directions").is_array() || member(document, "positions3d").is_array() ||
      member(document, "dome").is_object()) {
    return read_relight(document, file);
  }
  return bad_lights(file, "it is JSON with neither directions nor lights, as RelightLab and Meshroom write");
}

}  // namespace weft::solve
