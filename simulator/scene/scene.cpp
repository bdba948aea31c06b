// SPDX-License-Identifier: Apache-2.0
#include "simulator/scene/scene.h"

#include <utility>

#include "simulator/scene/scene_keys.h"
#include "simulator/scene/scene_reader.h"
#include "simulator/scene/scene_rules.h"
#include "simulator/scene/scene_writer.h"

namespace weft::simulator {
namespace {

/// Where a scene names a key, or the section it would stand in.
std::string place_of(const toml::table* table, const std::string& where, std::string_view key) {
  if (table == nullptr) return where;
  toml::node_view<const toml::node> node = table->at_path(key);
  if (!node) node = table->at_path(key.substr(0, key.find('.')));
  return node ? fmt::format("{}:{}", where, node.node()->source().begin.line) : where;
}

Result<Scene> read_table(const toml::table* table, SceneSource source, Scene scene) {
  SceneReader reader(table, "", source);
  walk(reader, scene);
  reader.refuse_unknown_keys();
  if (source.error) return *std::move(source.error);
  for (const SceneRule& rule : scene_rules()) {
    if (!rule.is_broken(scene)) continue;
    return Error{ErrorKind::kBadData, fmt::format("scene value \"{}\" cannot be used", rule.key),
                 place_of(table, source.where, rule.key), rule.why, rule.remedy};
  }
  return scene;
}

}  // namespace

std::span<const EffectKey> effect_keys() {
  using E = EffectSettings;
  static constexpr EffectKey kKeys[] = {
      {"near_light", &E::near_light},
      {"relief", &E::relief},
      {"finite_led", &E::finite_led},
      {"led_drift", &E::led_drift},
      {"stray", &E::stray},
      {"ambient", &E::ambient},
      {"cast_shadows", &E::cast_shadows},
      {"interreflection", &E::interreflection},
      {"translucency", &E::translucency},
      {"reflectance", &E::reflectance},
      {"spectral", &E::spectral},
      {"distortion", &E::distortion},
      {"movement", &E::movement},
      {"vignetting", &E::vignetting},
      {"field_curvature", &E::field_curvature},
      {"defocus", &E::defocus},
      {"chromatic_aberration", &E::chromatic_aberration},
      {"veil", &E::veil},
      {"bloom", &E::bloom},
      {"dark_current", &E::dark_current},
      {"uneven_response", &E::uneven_response},
      {"nonlinearity", &E::nonlinearity},
      {"noise", &E::noise},
  };
  return kKeys;
}

std::vector<LedRing> default_rings() {
  return {{4, 35, 0, 600}, {6, 62, 15, 600}};
}

Result<Scene> parse_scene_and_pictures(std::string_view text, const std::string& where,
                                       const ReadPicture& read_picture) {
  toml::table table;
  try {
    table = toml::parse(text, where);
  } catch (const toml::parse_error& wrong) {
    return Error{ErrorKind::kBadData, "scene is not TOML",
                 fmt::format("{}:{}", where, wrong.source().begin.line), std::string(wrong.description()),
                 "correct that line"};
  }
  return read_table(&table, {where, std::filesystem::path(where).parent_path(), read_picture, {}}, Scene());
}

Result<Scene> parse_scene(std::string_view text, const std::string& where) {
  return parse_scene_and_pictures(text, where, {});
}

Result<void> check_scene(const Scene& scene) {
  if (Result<Scene> checked = read_table(nullptr, {"scene", {}, {}, {}}, scene); !checked)
    return std::move(checked).error();
  const PrintSettings& print = scene.material.print;
  if (!print.file.empty() && !print.albedo) {
    return Error{ErrorKind::kBadData, "scene value \"material.print.file\" cannot be used", print.file,
                 "the picture has not been read", "read the scene from its file"};
  }
  return check_heights(scene.geometry);
}

std::string to_toml(const Scene& scene) {
  Scene copy = scene;
  SceneWriter writer;
  walk(writer, copy);
  return std::move(writer).text();
}

}  // namespace weft::simulator
