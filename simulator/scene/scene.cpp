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
      {"near_light", &E::near_light,
       "Direction, distance and lobe of each LED by pixel, from `mu` and the LEDs. Without it every LED "
       "lights all points as it lights the table's centre, and the calibration holds distant lights"},
      {"relief", &E::relief,
       "Evaluates light at the cloth's height, of `[geometry]`. Without it light is evaluated on the plane "
       "`cloth_height_mm`; slopes are simulated all the same"},
      {"finite_led", &E::finite_led,
       "LEDs are spheres of `led_radius_mm`, traced by `shadow_rays`: soft shadows, wider highlights. "
       "Without it LEDs are points"},
      {"led_drift", &E::led_drift,
       "LEDs fade over the session by `drift` and flicker by `flicker`. Without it every shot has the flux "
       "of the calibration"},
      {"stray", &E::stray, "Light of the LED that the rig reflects, `stray`"},
      {"ambient", &E::ambient, "Light of the room, `ambient`"},
      {"cast_shadows", &E::cast_shadows,
       "The cloth hides LEDs from parts of itself, traced by `shadow_rays`. Without it only surfaces that "
       "face away are dark"},
      {"interreflection", &E::interreflection,
       "The cloth lights itself, traced by `bounce_rays` and `bounces`"},
      {"translucency", &E::translucency,
       "Light enters a yarn and leaves beside it, by `[material.translucency]`. Without it light leaves "
       "where it falls"},
      {"reflectance", &E::reflectance,
       "Highlights and sheen, by `[material.reflectance]` or `preset`. Without it Lambert's law holds"},
      {"spectral", &E::spectral,
       "Colours are spectra, of `dye` and `[spectra]`, seen through the camera's filters. Without it colours "
       "are Rec.709"},
      {"distortion", &E::distortion,
       "Bends the picture, by `[camera.lens]`. Without it the camera is a pinhole with its principal point "
       "at the frame's centre"},
      {"movement", &E::movement,
       "The cloth shifts and turns between shots, by `[camera.movement]`. Without it the cloth lies still"},
      {"vignetting", &E::vignetting, "Darkens the frame towards its corners, by `[camera.vignette]`"},
      {"field_curvature", &E::field_curvature,
       "Blurs by a disc that grows towards the corners, by `[camera.field]`"},
      {"defocus", &E::defocus,
       "Blurs by a disc and by the lens's point spread, by `[camera.blur]`. Without it a pixel sees the "
       "point at its centre"},
      {"chromatic_aberration", &E::chromatic_aberration,
       "Shows red and blue at another scale than green, by `[camera.chromatic]`. Without it all colours have "
       "one scale"},
      {"veil", &E::veil, "Adds light that the lens spreads over the whole frame, by `[camera.veil]`"},
      {"bloom", &E::bloom,
       "Full photosites spill into their column, by `[camera.bloom]`. Without it they clip"},
      {"dark_current", &E::dark_current,
       "Photosites fill by warmth, too, and some are hot or dead, by `[camera.defects]`"},
      {"uneven_response", &E::uneven_response,
       "Photosites and columns differ in gain and black level, by `[camera.defects]`. Without it all are "
       "alike"},
      {"nonlinearity", &E::nonlinearity,
       "Counts do not follow light in a straight line, by `linearity`. Without it they do"},
      {"noise", &E::noise,
       "Photon noise (Poisson) of `full_well_electrons`, and read noise, `read_noise_electrons`"},
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
