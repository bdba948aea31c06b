// SPDX-License-Identifier: Apache-2.0
#include "bench/effects/effects_studies.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bench/effects/effect_scenes.h"
#include "core/base/parallel.h"
#include "core/image/raw_frame.h"
#include "core/image_io/image_io.h"
#include "report/preview.h"
#include "simulator/build_passes.h"
#include "simulator/reflectance/presets.h"

namespace weft::bench {
namespace {

/// A scene that shows one effect.
struct Example {
  std::string effect;  ///< its key
  std::string shows;   ///< a line below the title: what is on the table, and the effect's parameter
  simulator::Scene with, without;
  int led = 1;            ///< of the frame shown; 0: the dark one
  double brighten = 1;    ///< of light, before sRGB
  double difference = 0;  ///< how many times a third panel enlarges the change; 0: no such panel
};

using namespace simulator;
using E = EffectSettings;

constexpr Size kPanel = {300, 200};
constexpr double kTable_mm = 200;

/// A frame that sees `width_mm` of the table.
Scene frame_of(double width_mm) {
  Scene scene;
  scene.camera.width = 2 * kPanel.width;
  scene.camera.height = 2 * kPanel.height;
  scene.camera.mm_per_pixel = width_mm / scene.camera.width;
  return scene;
}

void light_from(Scene& scene, double zenith_deg, double azimuth_deg, double distance_mm) {
  scene.lights.rings = {{1, zenith_deg, azimuth_deg, distance_mm}};
}

/// Ten yarns across, red warp on a light weft, under one low LED from the upper left.
Scene close_weave(Family family) {
  Scene scene = frame_of(5);
  scene.geometry = family_settings(family);
  scene.material.warp_albedo = {0.62, 0.10, 0.08};
  scene.material.weft_albedo = {0.72, 0.66, 0.55};
  scene.material.yarn_variation = 0.1;
  light_from(scene, 62, 135, 600);
  return scene;
}

/// Thick yarns, so that they are seen across the whole table.
Scene table_weave() {
  Scene scene = frame_of(kTable_mm);
  scene.geometry = family_settings(Family::kPlain);
  scene.geometry.warp_pitch_mm = scene.geometry.weft_pitch_mm = 8;
  scene.material.albedo = {0.6, 0.55, 0.45};
  return scene;
}

Scene greys(double width_mm) {
  Scene scene = frame_of(width_mm);
  lay(scene, GreyScaleSettings{});
  scene.material.albedo = {0.2, 0.2, 0.2};
  return scene;
}

Example example(Effect effect, std::string shows, Scene scene) {
  Example made;
  for (const EffectKey& key : effect_keys()) {
    if (key.on == effect) made.effect = key.name;
  }
  made.shows = std::move(shows);
  made.without = made.with = std::move(scene);
  const auto add = [](EffectSettings& on, const EffectSettings& more) {
    for (const EffectKey& key : effect_keys()) on.*key.on = on.*key.on || more.*key.on;
  };
  add(made.with.effects, effects_for(effect));
  add(made.without.effects, effects_under(effect));
  return made;
}

Example near_light() {
  Scene scene = table_weave();
  light_from(scene, 45, 135, 220);
  scene.camera.albedo_at_full = 1;
  return example(&E::near_light, "LED at 220 mm, 200 mm of cloth", scene);
}

Example relief() {
  Scene scene = table_weave();
  scene.geometry.waves = {{.amplitude_mm = 8, .wavelength_mm = 90, .direction_deg = 30}};
  light_from(scene, 45, 135, 220);
  Example e = example(&E::relief, "waves of 8 mm, LED at 220 mm", scene);
  e.difference = 5;
  return e;
}

Example finite_led() {
  Scene scene = close_weave(Family::kDeep);
  scene.camera.mm_per_pixel /= 3;
  light_from(scene, 62, 135, 100);
  scene.lights.led_radius_mm = 10;
  scene.transport.shadow_rays = 64;
  scene.effects = effects_for(&E::cast_shadows);
  return example(&E::finite_led, "radius 10 mm at 100 mm, with cast shadows", scene);
}

Example led_drift() {
  Scene scene = close_weave(Family::kPlain);
  scene.lights.rings = {{2, 62, 135, 600}};
  scene.lights.drift = 0.2;
  Example e = example(&E::led_drift, "last shot of a session, drift 0.2", scene);
  e.led = 2;
  return e;
}

Example stray() {
  Scene scene = close_weave(Family::kDeep);
  scene.effects = effects_for(&E::cast_shadows);
  scene.lights.stray = 0.08;
  return example(&E::stray, "stray 0.08, with cast shadows", scene);
}

Example ambient() {
  Scene scene = close_weave(Family::kDeep);
  scene.lights.ambient = 0.05;
  Example e = example(&E::ambient, "the dark shot, ambient 0.05, times 8", scene);
  e.led = 0;
  e.brighten = 8;
  return e;
}

Example cast_shadows() {
  return example(&E::cast_shadows, "deep weave, LED 62° from the zenith", close_weave(Family::kDeep));
}

Example interreflection() {
  Scene scene = close_weave(Family::kDeep);
  scene.camera.mm_per_pixel *= 2;
  scene.material.weft_albedo = {0.9, 0.9, 0.9};
  scene.material.warp_albedo = {0.8, 0.05, 0.05};
  scene.effects = effects_for(&E::cast_shadows);
  return example(&E::interreflection, "two bounces, with cast shadows", scene);
}

Example translucency() {
  Scene scene = close_weave(Family::kDeep);
  scene.material.warp_albedo = scene.material.weft_albedo = Rgb{0.85, 0.82, 0.75};
  scene.material.translucency = {0.6, 0.15, {}, {}, {}, {}};
  scene.effects = effects_for(&E::cast_shadows);
  return example(&E::translucency, "share 0.6 over 0.15 mm, with cast shadows", scene);
}

Scene satin_scene() {
  Scene scene = close_weave(Family::kPlain);
  const ClothPreset satin = *preset("satin");
  scene.geometry = {};
  scene.geometry.kind = GeometryKind::kSatin;
  scene.geometry.twist_relief = 0.01;
  scene.material.warp_albedo = Rgb{0.30, 0.05, 0.12};
  scene.material.weft_albedo = Rgb{0.20, 0.03, 0.10};
  scene.material.reflectance = satin.reflectance;
  light_from(scene, 35, 90, 600);
  return scene;
}

Example reflectance() {
  return example(&E::reflectance, "satin weave, preset satin", satin_scene());
}

Example spectral() {
  Scene scene = close_weave(Family::kPlain);
  scene.material = {};
  add_spectra(scene);
  return example(&E::spectral, "two dyes as an observer and as the camera see them", scene);
}

Example distortion() {
  Scene scene = frame_of(kTable_mm);
  lay(scene, CheckerboardSettings{.squares_x = 12, .squares_y = 8});
  scene.camera.lens = {.k1 = -1};
  return example(&E::distortion, "k1 -1", scene);
}

Example movement() {
  Example e = example(&E::movement, "sigma 0.02 mm and 0.005° a shot", close_weave(Family::kPlain));
  e.difference = 1;
  return e;
}

Example vignetting() {
  Scene scene = frame_of(kTable_mm);
  scene.camera.distance_mm = 250;
  scene.camera.vignette.corner_loss = 0.2;
  light_from(scene, 0, 0, 600);
  scene.material.albedo = {0.6, 0.6, 0.6};
  return example(&E::vignetting, "flat card seen from 250 mm, corner loss 0.2", scene);
}

Example field_curvature() {
  Scene scene = frame_of(kTable_mm);
  lay(scene, CheckerboardSettings{.squares_x = 12, .squares_y = 8});
  scene.camera.field.corner_px = 16;
  return example(&E::field_curvature, "disc of 16 photosites in the corners", scene);
}

Example defocus() {
  Scene scene = close_weave(Family::kPlain);
  scene.camera.blur = {.defocus_px = 12, .spread_px = 1};
  return example(&E::defocus, "disc of 12 photosites, spread 1", scene);
}

Example chromatic_aberration() {
  Scene scene = frame_of(kTable_mm);
  lay(scene, CheckerboardSettings{.squares_x = 12, .squares_y = 8});
  scene.camera.chromatic = {6, -6};
  return example(&E::chromatic_aberration, "red 6 photosites out, blue 6 in", scene);
}

Example veil() {
  Scene scene = greys(kTable_mm * 1.1);
  scene.material.albedo = {0.02, 0.02, 0.02};
  scene.camera.veil.share = 0.2;
  Example e = example(&E::veil, "share 0.2", scene);
  e.difference = 5;
  return e;
}

Example bloom() {
  Scene scene = close_weave(Family::kPlain);
  lay(scene, TagSettings{.side_mm = 2, .margin_mm = 0.3});
  scene.material.warp_albedo = scene.material.weft_albedo = Rgb{0.06, 0.06, 0.06};
  scene.camera.albedo_at_full = 0.15;
  scene.camera.bloom = {.share = 0.5, .decay = 0.9};
  return example(&E::bloom, "a tag six times over full scale", scene);
}

Example dark_current() {
  Scene scene = frame_of(5);
  scene.camera.exposure_us = 2e6;
  scene.camera.defects.hot_per_million = 3000;
  Example e = example(&E::dark_current, "dark shot of 2 s, 3000 hot per million, times 5", scene);
  e.led = 0;
  e.brighten = 5;
  return e;
}

Example uneven_response() {
  Scene scene = close_weave(Family::kPlain);
  scene.camera.defects.response_percent = 2;
  scene.camera.defects.column_counts = 100;
  scene.camera.defects.photosite_counts = 30;
  Example e = example(&E::uneven_response, "2 %, columns 100 and photosites 30 counts", scene);
  e.difference = 8;
  return e;
}

Example nonlinearity() {
  Scene scene = greys(kTable_mm * 1.1);
  scene.camera.linearity = {0.1, -0.05};
  Example e = example(&E::nonlinearity, "grey scale, linearity 0.1, -0.05", scene);
  e.difference = 5;
  return e;
}

Example noise() {
  Scene scene = close_weave(Family::kPlain);
  scene.camera.iso = 6400;
  return example(&E::noise, "ISO 6400: 625 electrons are full scale", scene);
}

Example everything() {
  Scene scene = satin_scene();
  scene.camera.mm_per_pixel *= 3;
  scene.geometry.folds = {{.amplitude_mm = 1.5, .wavelength_mm = 14, .direction_deg = 60, .sharpness = 2}};
  light_from(scene, 50, 80, 600);
  scene.camera.albedo_at_full = 0.5;
  Example e;
  e.effect = "all";
  e.shows = "folded satin, every effect at its defaults";
  e.without = e.with = scene;
  e.with.effects = all_effects();
  e.with.effects.spectral = false;
  return e;
}

// One for every effect in the order of light, and last one for all together.
std::vector<Example> effect_examples() {
  return {near_light(),
          relief(),
          finite_led(),
          led_drift(),
          stray(),
          ambient(),
          cast_shadows(),
          interreflection(),
          translucency(),
          reflectance(),
          spectral(),
          distortion(),
          movement(),
          vignetting(),
          field_curvature(),
          defocus(),
          chromatic_aberration(),
          veil(),
          bloom(),
          dark_current(),
          uneven_response(),
          nonlinearity(),
          noise(),
          everything()};
}

using report::Picture;

/// Light by cell of four photosites: planes R, G, B, white-balanced, 1 is full scale.
struct Shown {
  Image<float> light;
  double seconds = 0;
};

Result<Shown> frame_of(const Scene& scene, int led, int threads) {
  const Result<SceneRig> rig = rig_of(scene);
  if (!rig) return rig.error();
  Result<PassList> passes = build_passes(scene, *rig, Output::kCounts);
  if (!passes) return passes.error();
  const Size size = rig->camera.size;
  Shown shown = {Image<float>({size.width / 2, size.height / 2}, 3), 0};
  constexpr CfaPattern kCfa;
  constexpr std::array<double, 3> kShare = {1, 0.5, 1};  // of a photosite in its cell: two are green
  const Sensor& sensor = rig->sensor;
  PassRunner runner(std::move(*passes), {.threads = threads});
  Result<void> ran;
  shown.seconds = least_seconds(1, [&] {
    ran = runner.run(
        {0, 0, size.width, size.height}, {&led, 1}, {}, [](const PassTile&) {},
        [&](const PassTile& tile) {
          for_each_pixel(tile.rect, [&](std::size_t i, int x, int y) {
            const int c = kCfa.channel_at(x, y);
            const auto channel = static_cast<std::size_t>(c);
            const double signal = (tile.counts[i] - sensor.black) / (sensor.white - sensor.black);
            shown.light(x / 2, y / 2, c) +=
                static_cast<float>(kShare[channel] * signal / scene.lights.white_balance[channel]);
          });
        });
  });
  if (!ran) return ran.error();
  return shown;
}

/// level(i of a plane and pixel) for all three planes, in sRGB.
template <typename Level>
Picture picture_of(Size size, const Level& level) {
  Picture picture(size, 3);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) picture(x, y, c) = report::srgb_from_linear(level(x, y, c));
    }
  }
  return picture;
}

Result<void> write_sheet(const std::filesystem::path& file, const Example& example, const Image<float>& off,
                         const Image<float>& on) {
  const Size size = {on.width(), on.height()};
  const auto brighten = static_cast<float>(example.brighten);
  const auto lit = [&](const Image<float>& light) {
    return picture_of(size, [&](int x, int y, int c) { return brighten * light(x, y, c); });
  };
  std::vector<report::Panel> panels;
  panels.push_back({"off", "", lit(off)});
  panels.push_back({"on", example.shows, lit(on)});
  if (example.difference > 0) {
    constexpr float kMiddle = 0.2F;
    const auto times = static_cast<float>(example.difference);
    panels.push_back({fmt::format("difference × {:g}", example.difference), "grey: none",
                      picture_of(size, [&](int x, int y, int c) {
                        return kMiddle + times * (on(x, y, c) - off(x, y, c));
                      })});
  }
  const Picture sheet = report::contact_sheet(example.effect, panels, static_cast<int>(panels.size()));
  return write_image(file, std::array<View<const float>, 3>{sheet.plane(0), sheet.plane(1), sheet.plane(2)},
                     {"R", "G", "B"}, {.type = SampleType::kUint8});
}

}  // namespace

/// Writes effects_NAME.png for every effect into `folder`, which is made: a small scene without the effect
/// and with it, and where that is little to see their difference, so many times enlarged, about middle grey.
/// A pixel of the picture is a cell of four photosites, white-balanced, in sRGB. Returns a row a picture with
/// its file, and its time over all pixels drawn; `ratio` is that over the scene without the effect.
Result<Rows> effects_gallery(const std::filesystem::path& folder, int threads) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) {
    return Error{ErrorKind::kCannotCreate, "cannot make the folder of pictures", folder.string(),
                 failed.message(), "choose another folder"};
  }
  Rows rows;
  for (const Example& example : effect_examples()) {
    const Result<Shown> off = frame_of(example.without, example.led, threads);
    if (!off) return off.error();
    const Result<Shown> on = frame_of(example.with, example.led, threads);
    if (!on) return on.error();
    const std::filesystem::path file = folder / ("effects_" + example.effect + ".png");
    if (Result<void> ok = write_sheet(file, example, off->light, on->light); !ok) return ok.error();
    const double photosites = 4.0 * on->light.width() * on->light.height();
    rows.push_back({{"effect", example.effect},
                    {"ns_per_pixel", on->seconds * 1e9 / photosites},
                    {"threads", resolved_threads(threads)},
                    {"ratio", on->seconds / off->seconds},
                    {"shows", example.shows},
                    {"file", file.string()}});
  }
  return rows;
}

}  // namespace weft::bench
