// SPDX-License-Identifier: Apache-2.0
#include "simulator/scene/scene_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/rig/exposure_words.h"
#include "simulator/camera/optics.h"
#include "simulator/light/incidence.h"
#include "simulator/spectra/observer.h"
#include "simulator/targets/target.h"

namespace weft::simulator {
namespace {

constexpr double kFullScaleShare = 0.90;
constexpr std::size_t kMostLeds = 256;
constexpr double kLongestExposure_us = 1e9;

Error refusal(std::string what, std::string why, std::string remedy) {
  return {ErrorKind::kBadData, std::move(what), "scene", std::move(why), std::move(remedy)};
}

std::vector<NearLight> place_leds(const LightSettings& lights) {
  NearLight common;
  common.mu = lights.mu;
  for (std::size_t c = 0; c < 3; ++c) common.flux_rgb[c] = lights.flux * lights.white_balance[c];

  std::vector<NearLight> leds;
  const auto place = [&](Vec3 position_mm) -> NearLight& {
    NearLight& led = leds.emplace_back(common);
    led.position_mm = position_mm;
    led.aim = normalized(-1.0 * position_mm);
    return led;
  };
  const bool is_default = lights.rings.empty() && lights.leds.empty();
  for (const LedRing& ring : is_default ? default_rings() : lights.rings) {
    const double zenith = radians(ring.zenith_deg);
    for (int i = 0; i < ring.count; ++i) {
      const double azimuth = radians(ring.azimuth_deg + 360.0 * i / ring.count);
      place(ring.distance_mm * Vec3{std::sin(zenith) * std::cos(azimuth),
                                    std::sin(zenith) * std::sin(azimuth), std::cos(zenith)});
    }
  }
  for (const LedSettings& own : lights.leds) {
    NearLight& led = place(own.position_mm);
    if (own.aim) led.aim = normalized(*own.aim);
    led.mu = own.mu.value_or(common.mu);
    led.flux_rgb = own.flux_rgb.value_or(common.flux_rgb);
  }
  return leds;
}

Result<void> check_places(const Scene& scene, const std::vector<NearLight>& leds) {
  const double height_mm = scene.geometry.cloth_height_mm;
  if (leds.size() > kMostLeds) {
    return refusal("too many LEDs", fmt::format("{} of at most {}", leds.size(), kMostLeds), "remove some");
  }
  for (std::size_t i = 0; i < leds.size(); ++i) {
    const double over_cloth_mm = seen_from(scene.pose, height_mm, leds[i].position_mm).z;
    if (over_cloth_mm > height_mm && leds[i].position_mm.z > 0) continue;
    return refusal(fmt::format("LED {} is not above table and cloth", i + 1),
                   fmt::format("it is at z = {} mm and the cloth at {} mm", leds[i].position_mm.z, height_mm),
                   "raise it, or lower geometry.cloth_height_mm or pose.tilt_deg");
  }
  if (scene.blade.led > static_cast<int>(leds.size())) {
    return refusal(fmt::format("there is no LED {} to throw the blade's shadow", scene.blade.led),
                   fmt::format("the scene has {}", leds.size()), "name another in blade.led");
  }
  if (scene.camera.distance_mm > height_mm) return {};
  return refusal("the camera is not above the cloth",
                 fmt::format("it is at {} mm and the cloth at {} mm", scene.camera.distance_mm, height_mm),
                 "raise camera.distance_mm or lower geometry.cloth_height_mm");
}

/// What check_scene() cannot know of a scene's parts: whether a filter passes anything of the LED, and
/// whether a target can be made.
Result<void> check_parts(const Scene& scene) {
  if (scene.effects.spectral) {
    if (const auto camera = camera_weights(scene.spectra.led, scene.spectra.filters); !camera) {
      return camera.error();
    }
  }
  for (std::size_t i = 0; i < scene.targets.size(); ++i) {
    const auto target = Target::make(scene.targets[i], scene.seed, static_cast<int>(i));
    if (!target) return target.error();
    if (const auto inks = inks_of(scene.targets[i], scene.spectra.chart); !inks) return inks.error();
  }
  return {};
}

Result<void> place_camera(const Scene& scene, SceneRig& rig) {
  const CameraSettings& c = scene.camera;
  LensSettings lens = scene.effects.distortion ? c.lens : LensSettings();
  const Result<CameraModel> camera = camera_of({c.width, c.height}, c.distance_mm, c.mm_per_pixel, lens,
                                               c.pose, scene.geometry.cloth_height_mm);
  if (!camera) return camera.error();
  rig.camera = *camera;
  if (lens == LensSettings() && c.pose == PoseSettings()) return {};
  const Result<Lens> ready = Lens::of(rig.camera);
  if (!ready) return ready.error();
  rig.lens = *ready;
  return {};
}

void place_films(const FilmSettings& films, SceneRig& rig) {
  if (films.states == FilmStates::kNone) return;
  const double scattered = films.transmission * films.transmission / 4;
  for (NearLight& led : rig.leds.leds) {
    for (double& flux : led.flux_rgb) flux *= scattered;
  }
  rig.lobe_share = lobe_share_of(films, films.states);
  rig.room_share = films.transmission / 2 / scattered;
}

/// Readings that a white surface gives where it faces the LED, in the brightest channel of the brightest LED.
double brightest_reading(const DistantLights& lights) {
  double brightest = 0;
  for (const DistantLight& light : lights.lights) {
    brightest =
        std::max(brightest, *std::max_element(light.irradiance_rgb.begin(), light.irradiance_rgb.end()));
  }
  return brightest;
}

/// A model as readers of raw files call it: the maker's name is not repeated.
std::string name_of_model(const Sensor& sensor) {
  const std::string maker = sensor.make.substr(0, sensor.make.find(' '));
  return sensor.model.starts_with(maker + " ") ? sensor.model.substr(maker.size() + 1) : sensor.model;
}

}  // namespace

std::vector<Rgb> SceneRig::signal_of_unit(double iso) const {
  std::vector<Rgb> signals;
  for (const NearLight& led : leds.leds) {
    const double seconds = exposure(iso);
    signals.push_back({led.flux_rgb[0] * seconds, led.flux_rgb[1] * seconds, led.flux_rgb[2] * seconds});
  }
  return signals;
}

DistantLights distant_lights(const SceneRig& rig, double cloth_height_mm) {
  DistantLights distant;
  for (const NearLight& led : rig.leds.leds) {
    const Incidence light = incidence(led, {0, 0, cloth_height_mm});
    const std::array<double, 3>& flux = led.flux_rgb;
    distant.lights.push_back(
        {light.direction, {flux[0] * light.strength, flux[1] * light.strength, flux[2] * light.strength}});
  }
  return distant;
}

Vec3 SceneRig::camera_centre_mm() const {
  return centre_of(camera);
}

DefectSettings defects_of(const Scene& scene) {
  DefectSettings defects = scene.camera.defects;
  if (!scene.effects.dark_current) {
    defects.dark_electrons_per_s = defects.hot_per_million = defects.dead_per_million = 0;
  }
  if (!scene.effects.uneven_response) {
    defects.response_percent = defects.column_counts = defects.photosite_counts = 0;
    defects.cell_counts = {};
  }
  return defects;
}

double lobe_share_of(const FilmSettings& films, FilmStates state) {
  if (state == FilmStates::kNone) return 1;
  return state == FilmStates::kParallel ? 2 : 2 * films.leak;
}

Result<SceneRig> rig_of(const Scene& scene) {
  if (Result<void> ok = check_scene(scene); !ok) return ok.error();
  if (Result<void> ok = check_parts(scene); !ok) return ok.error();
  SceneRig rig;
  rig.leds.leds = place_leds(scene.lights);
  if (Result<void> ok = check_places(scene, rig.leds.leds); !ok) return ok.error();
  place_films(scene.films, rig);
  rig.sensor = sensor_of(scene.camera);
  if (Result<void> ok = place_camera(scene, rig); !ok) return ok.error();

  rig.blade_lies = scene.blade.lies;
  const double reading = brightest_reading(distant_lights(rig, scene.geometry.cloth_height_mm));
  if (reading <= 0) {
    return refusal("no LED lights the table's centre", "every aim points away or every flux is 0",
                   "correct the section [lights]");
  }
  const CameraSettings& camera = scene.camera;
  rig.exposure_us = std::round(camera.exposure_us.value_or(
      1e6 * kFullScaleShare / (camera.albedo_at_full * reading * camera.iso / 100)));
  if (rig.exposure_us < 1 || rig.exposure_us > kLongestExposure_us) {
    return refusal("no exposure fits the lights",
                   fmt::format("{} would be needed, {} to {} can be had", exposure_words(rig.exposure_us),
                               exposure_words(1), exposure_words(kLongestExposure_us)),
                   "change lights.flux or camera.iso");
  }
  return rig;
}

Result<SceneRig> seen_from_cloth(const Scene& scene, SceneRig rig) {
  if (scene.pose.is_level()) return rig;
  const double height_mm = scene.geometry.cloth_height_mm;
  rig.leds = std::get<NearLights>(seen_from(scene.pose, height_mm, Lights(std::move(rig.leds))));
  rig.camera = seen_from(scene.pose, height_mm, rig.camera);
  if (Result<void> ok = check_camera(rig.camera, height_mm); !ok) return std::move(ok).error();
  const Result<Lens> lens = Lens::of(rig.camera);
  if (!lens) return lens.error();
  rig.lens = *lens;
  return rig;
}

double bracket_exposure_us(const RetakeSettings& retakes, const SceneRig& rig, bool as_gathered) {
  const double taken_us = std::max(std::round(rig.exposure_us * retakes.bracket.value_or(1)), 1.0);
  return as_gathered ? taken_us * (1 + retakes.shutter_error) : taken_us;
}

Calibration exact_calibration(const Scene& scene, const SceneRig& rig) {
  Calibration calibration;
  calibration.subject.rig = "virtual rig";
  calibration.subject.camera_model = name_of_model(rig.sensor);
  calibration.subject.camera_serial = "virtual";
  calibration.subject.f_number = scene.camera.f_number;
  calibration.subject.focal_length_mm = kFocalLength_mm;
  calibration.subject.albedo_scale = AlbedoScale::kAbsolute;
  calibration.camera = rig.camera;
  if (scene.effects.defocus) calibration.spread.emplace().sigma_px.fill(spread_px(scene.camera.blur));
  if (scene.effects.chromatic_aberration) {
    const double corner_px = corner_distance_px(rig.camera);
    calibration.lateral.emplace().red.scale = -scene.camera.chromatic.red_px / corner_px;
    calibration.lateral->blue.scale = -scene.camera.chromatic.blue_px / corner_px;
  }
  calibration.response = response_of(rig.sensor);
  if (scene.effects.veil) calibration.response->veil = {scene.camera.veil.share, 0, scene.camera.veil.spread};
  if (scene.effects.nonlinearity) calibration.response->linearity.fill(scene.camera.linearity);
  if (const RetakeSettings& retakes = scene.camera.retakes; retakes.bracket) {
    calibration.response->exposure_ratios = {{bracket_exposure_us(retakes, rig, false), rig.exposure_us,
                                              bracket_exposure_us(retakes, rig, true) / rig.exposure_us}};
  }
  if (!scene.effects.near_light) {
    calibration.lights = distant_lights(rig, scene.geometry.cloth_height_mm);
    return calibration;
  }
  NearLights lights = rig.leds;
  if (scene.effects.vignetting) {
    const GainFit gain = fit_gain(Vignette(scene.camera.vignette, rig.camera), rig.camera.size);
    lights.log_gain_rgb.fill(gain.spline);
    for (NearLight& led : lights.leds) {
      for (double& flux : led.flux_rgb) flux *= std::exp(gain.mean_log_gain);
    }
  }
  calibration.lights = std::move(lights);
  return calibration;
}

}  // namespace weft::simulator
