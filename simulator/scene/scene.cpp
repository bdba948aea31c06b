// SPDX-License-Identifier: Apache-2.0
#include "simulator/scene/scene.h"

#include <algorithm>
#include <utility>

#include "simulator/scene/scene_keys.h"
#include "simulator/scene/scene_reader.h"
#include "simulator/scene/scene_writer.h"

namespace weft::simulator {
namespace {

bool has_yarn_colours(const MaterialSettings& m) {
  return m.warp_albedo || m.weft_albedo || m.warp_dye || m.weft_dye || m.stripe_yarns > 0 ||
         m.yarn_variation > 0;
}

bool tells_yarns_apart(const TranslucencySettings& t) {
  return t.warp_share || t.weft_share || t.warp_mean_mm || t.weft_mean_mm;
}

bool has_chart(const Scene& s) {
  return std::any_of(s.targets.begin(), s.targets.end(),
                     [](const TargetSettings& t) { return kind_of(t.pattern) == TargetKind::kChart; });
}

bool passes_nothing(const Spectrum& s) {
  return std::all_of(s.samples.begin(), s.samples.end(), [](double share) { return share == 0; });
}

bool has_photosites(const EffectSettings& e) {
  return e.bloom || e.dark_current || e.uneven_response || e.nonlinearity;
}

bool loses_readings(const Scene& s) {
  return std::any_of(s.damage.begin(), s.damage.end(),
                     [](const DamageSettings& d) { return d.kind == DamageKind::kMissing; });
}

constexpr const char* kNearLight = "set near_light = true, or leave it out";
constexpr const char* kRelief = "set relief = true, or leave it out";
constexpr const char* kOneColour = "keep one of the two";

constexpr SceneRule kRules[] = {
    {"material", [](const Scene& s) { return !is_woven(s.geometry.kind) && has_yarn_colours(s.material); },
     "it has colours for yarns, and this geometry has none",
     "remove them, or choose a woven kind of geometry"},
    {"material.translucency",
     [](const Scene& s) { return !is_woven(s.geometry.kind) && tells_yarns_apart(s.material.translucency); },
     "it tells warp from weft, and this geometry has neither",
     "give \"share\" and \"mean_mm\" alone, or choose a woven kind of geometry"},
    {"material.dye",
     [](const Scene& s) { return s.material.dye && s.material.albedo != MaterialSettings().albedo; },
     "\"albedo\" gives the same cloth another colour", kOneColour},
    {"material.warp_dye", [](const Scene& s) { return s.material.warp_dye && s.material.warp_albedo; },
     "\"warp_albedo\" gives the same yarns another colour", kOneColour},
    {"material.weft_dye", [](const Scene& s) { return s.material.weft_dye && s.material.weft_albedo; },
     "\"weft_albedo\" gives the same yarns another colour", kOneColour},
    {"target", [](const Scene& s) { return has_chart(s) && s.spectra.chart.empty(); },
     "the patches of a chart are spectra, and there are none",
     "give spectra.chart a folder or a list of 24 spectra"},
    {"ball", [](const Scene& s) { return s.auto_to_sigma && !s.balls.empty(); },
     "the bounds of automatic effects do not know balls", "name the effects, or leave the ball out"},
    {"blade", [](const Scene& s) { return s.auto_to_sigma && (s.blade.led > 0 || s.blade.lies); },
     "the bounds of automatic effects do not know blades", "name the effects, or leave the blade out"},
    {"effects.finite_led", [](const Scene& s) { return s.effects.finite_led && !s.effects.near_light; },
     "without near_light every LED is infinitely far away and has no size", kNearLight},
    {"effects.relief", [](const Scene& s) { return s.effects.relief && !s.effects.near_light; },
     "without near_light no height of the cloth brings it nearer to a LED", kNearLight},
    {"effects.vignetting", [](const Scene& s) { return s.effects.vignetting && !s.effects.near_light; },
     "without near_light the calibration holds distant lights, which have no place for a vignette",
     kNearLight},
    {"effects.cast_shadows", [](const Scene& s) { return s.effects.cast_shadows && !s.effects.relief; },
     "shadows are cast by the height of the cloth, which only relief lets light see", kRelief},
    {"effects.interreflection", [](const Scene& s) { return s.effects.interreflection && !s.effects.relief; },
     "light is traced over the height of the cloth, which only relief lets light see", kRelief},
    {"effects.spectral",
     [](const Scene& s) {
       const MaterialSettings& m = s.material;
       return s.effects.spectral && !m.dye && !(m.warp_dye && m.weft_dye) && !has_chart(s);
     },
     "neither a dye nor a chart says what there is to see by wavelength",
     "give material.dye, or warp_dye and weft_dye, or put a chart on the table"},
    {"effects.spectral",
     [](const Scene& s) {
       return s.effects.spectral &&
              (passes_nothing(s.spectra.led) ||
               std::any_of(s.spectra.filters.begin(), s.spectra.filters.end(), passes_nothing));
     },
     "the LED shines nothing or a filter of the camera passes nothing",
     "give led and filters in the section [spectra]"},
    {"frames", [](const Scene& s) { return s.frames == FrameFormat::kExr && has_photosites(s.effects); },
     "bloom, dark_current, uneven_response and nonlinearity act on photosites, and developed frames have "
     "none",
     "leave these effects out, or set frames = \"dng\""},
    {"damage", [](const Scene& s) { return s.frames == FrameFormat::kDng && loses_readings(s); },
     "the whole counts of a raw file have no way to say that one is missing", "set frames = \"exr\""},
};

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

std::span<const SceneRule> scene_rules() {
  return kRules;
}

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
