// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/image/color_spaces.h"
#include "core/rig/cloth_pose.h"
#include "simulator/camera/camera_settings.h"
#include "simulator/geometry/geometry_settings.h"
#include "simulator/geometry/print.h"
#include "simulator/reflectance/reflectance.h"
#include "simulator/scene/scene.h"
#include "simulator/spectra/spectrum.h"
#include "simulator/targets/table_ball.h"
#include "simulator/targets/target_settings.h"

// A scene says what is on the table, what lights it, what photographs it and which effects are simulated.
// docs/reference/scenes.md lists every key; millimetres and the rig frame throughout.

namespace weft::simulator {

/// Light that enters a yarn and leaves beside where it entered.
struct YarnTranslucency {
  double share = 0;    ///< of the light that falls on the yarn, 0 to 0.9
  double mean_mm = 0;  ///< mean distance between where light enters and where it leaves, 0.001 to 5
};
struct TranslucencySettings {
  double share = 0;
  double mean_mm = 0.3;
  std::optional<double> warp_share, weft_share;      ///< instead of `share`
  std::optional<double> warp_mean_mm, weft_mean_mm;  ///< instead of `mean_mm`

  /// The warp and the weft; cloth that is not woven counts as warp.
  std::array<YarnTranslucency, 2> yarns() const {
    return {{{warp_share.value_or(share), warp_mean_mm.value_or(mean_mm)},
             {weft_share.value_or(share), weft_mean_mm.value_or(mean_mm)}}};
  }

  bool operator==(const TranslucencySettings&) const = default;
};

/// Colour and gloss of the cloth.
struct MaterialSettings {
  Rgb albedo = {0.5, 0.5, 0.5};
  std::optional<Rgb> warp_albedo;  ///< instead of `albedo` for the warp
  std::optional<Rgb> weft_albedo;  ///< instead of `albedo` for the weft
  /// 0: the warp has one colour and the weft the other. n: both sets have n yarns of one, then n of the
  /// other.
  int stripe_yarns = 0;
  double yarn_variation = 0;  ///< albedo of a yarn is multiplied by 1 +- this, uniformly
  PrintSettings print;        ///< a pattern over the yarns' colours, which it multiplies

  /// spectral: dyes in the place of the albedos above.
  std::optional<Spectrum> dye;
  std::optional<Spectrum> warp_dye;
  std::optional<Spectrum> weft_dye;

  Reflectance reflectance = Lambert{};  ///< reflectance
  TranslucencySettings translucency;    ///< translucency

  bool operator==(const MaterialSettings&) const = default;
};

/// LEDs on a circle around the z axis, aimed at the table's centre.
struct LedRing {
  int count = 1;
  double zenith_deg = 45;
  double azimuth_deg = 0;    ///< of the first LED, from x towards y
  double distance_mm = 600;  ///< from the table's centre

  bool operator==(const LedRing&) const = default;
};

/// One LED. What is absent follows LightSettings; without an aim it points at the table's centre.
struct LedSettings {
  Vec3 position_mm;
  std::optional<Vec3> aim;
  std::optional<double> mu;
  std::optional<Rgb> flux_rgb;  ///< reading * mm^2 / s at ISO 100

  bool operator==(const LedSettings&) const = default;
};

/// Four LEDs at a zenith angle of 35 degrees and six at 62, turned by 15.
std::vector<LedRing> default_rings();

/// The LEDs of a scene, and light from elsewhere.
struct LightSettings {
  double flux = 2e7;                   ///< of the green channel: reading * mm^2 / s at ISO 100
  Rgb white_balance = {0.5, 1, 0.68};  ///< flux by channel is `flux` times this
  double mu = 1;                       ///< lobe exponent: 0 isotropic, 1 Lambertian
  double led_radius_mm = 0.75;         ///< finite_led
  double drift = 0.003;                ///< led_drift: what the last shot's LED has lost against the first's
  double flicker = 0.001;              ///< led_drift: standard deviation of a shot's brightness, relative
  /// Shares of what a white surface at the table's centre that faces the LED reflects, evenly from all sides.
  double stray = 0.002;    ///< stray: by way of the rig
  double ambient = 0.001;  ///< ambient: from the room, in units of the brightest LED
  /// LED 1 is the first of the first ring; `leds` follow the rings. With neither there are the
  /// default_rings().
  std::vector<LedRing> rings;
  std::vector<LedSettings> leds;

  bool operator==(const LightSettings&) const = default;
};

/// Which films stand before LEDs and lens, one after the other.
enum class FilmStates { kNone, kCrossed, kParallel, kBoth };

/// Linear polarisers before every LED and the lens. Light that the cloth scatters has lost its polarisation:
/// a quarter of it passes. Light that the surface mirrors keeps it: half passes parallel films, and of that
/// half `leak` passes crossed ones. Light of the room meets the lens's film alone: half passes.
struct FilmSettings {
  FilmStates states = FilmStates::kNone;
  double leak = 0.01;
  double transmission = 1;  ///< of light along a film's axis, one film

  bool operator==(const FilmSettings&) const = default;
};

/// spectral: what shines and what filters, from 380 to 730 nm.
struct SpectraSettings {
  Spectrum led = flat_spectrum(1);
  std::array<Spectrum, 3> filters = {};  ///< red, green, blue
  std::vector<Spectrum> chart;           ///< the patches of a colour chart, row by row; 24 or none

  bool operator==(const SpectraSettings&) const = default;
};

/// A thin opaque strip with straight edges, level above the cloth: how light spreads in cloth is told by the
/// edge of its shadow.
struct BladeSettings {
  int led = 0;        ///< which a session photographs once more with the blade, at its end; 0: none
  bool lies = false;  ///< in every photograph
  double x_mm = 0;    ///< the middle of one edge
  double y_mm = 0;
  double turn_deg = 90;  ///< where that edge runs, from x towards y; the blade lies to its left
  double height_mm = 8;  ///< above the cloth
  double length_mm = 200;
  double width_mm = 20;
  double albedo = 0.03;

  bool operator==(const BladeSettings&) const = default;
};

/// How light is traced over the cloth. `bounces` and rays make interreflection exact, at their price.
struct TransportSettings {
  int shadow_rays = 16;  ///< cast_shadows, where LEDs are finite
  int bounce_rays = 64;  ///< interreflection
  int bounces = 2;       ///< interreflection

  bool operator==(const TransportSettings&) const = default;
};

/// What is simulated beyond the ideal picture; effect_keys() says what each is. An effect that a scene does
/// not name does not run.
struct EffectSettings {
  bool near_light = false;
  bool relief = false;
  bool finite_led = false;
  bool led_drift = false;
  bool stray = false;
  bool ambient = false;
  bool cast_shadows = false;
  bool interreflection = false;
  bool translucency = false;
  bool reflectance = false;
  bool spectral = false;
  bool distortion = false;
  bool movement = false;
  bool vignetting = false;
  bool field_curvature = false;
  bool defocus = false;
  bool chromatic_aberration = false;
  bool veil = false;
  bool bloom = false;
  bool dark_current = false;
  bool uneven_response = false;
  bool nonlinearity = false;
  bool noise = false;

  bool operator==(const EffectSettings&) const = default;
};

/// An effect by the key that names it.
struct EffectKey {
  const char* name;
  bool EffectSettings::*on;
  const char* says;  ///< what it does, by which keys, and what holds without it; in Markdown
};
/// All effects in the order of light.
std::span<const EffectKey> effect_keys();

/// How the frames of a session are stored.
enum class FrameFormat {
  kDng,  ///< raw mosaics of whole counts, as a camera stores them
  kExr,  ///< developed: linear R, G, B as 32-bit floats, 1 at full scale, nothing clipped
};

/// What damaged pixels hold.
enum class DamageKind {
  kMissing,    ///< NaN
  kSaturated,  ///< +infinity in EXR frames, white in raw ones
  kBlack,      ///< 0, as if nothing were lit
  kFade,       ///< exposure falls from the top of the part to its bottom
};

/// Part of some frames that is not as the camera saw it: what no rig should do, for what must survive it.
struct DamageSettings {
  DamageKind kind = DamageKind::kMissing;
  int first_led = 1;  ///< to the shots of these LEDs
  int last_led = 256;
  double left = 0;  ///< the part, in shares of the frame from its upper left corner
  double right = 1;
  double top = 0;
  double bottom = 1;
  double decades = 12;  ///< kFade: powers of ten

  bool operator==(const DamageSettings&) const = default;
};

/// Everything that a simulation needs to know.
struct Scene {
  std::string fabric = "simulated cloth";
  std::int64_t seed = 1;  ///< of all random numbers, from 0
  CameraSettings camera;
  GeometrySettings geometry;
  MaterialSettings material;
  LightSettings lights;
  FilmSettings films;
  SpectraSettings spectra;
  TransportSettings transport;
  /// The plane of the cloth, its folds and all targets, tilted under lights and camera. Truth is that of the
  /// plane itself.
  ClothPose pose;
  FrameFormat frames = FrameFormat::kDng;
  std::vector<DamageSettings> damage;   ///< in this order
  std::vector<TargetSettings> targets;  ///< on the table beside or over the cloth
  std::vector<BallSettings> balls;      ///< over both
  BladeSettings blade;                  ///< over all
  EffectSettings effects;
  /// `effects = "auto"`: the effects that run are those whose bound exceeds this many sigma of the photon
  /// noise (simulator/effects/bounds.h); `effects` above is not used.
  std::optional<double> auto_to_sigma;

  bool operator==(const Scene&) const = default;
};

/// Reads a scene in TOML. An unknown key is kBadData with its line and the nearest key that exists; so is a
/// value of the wrong type or out of its range, with what is allowed; so are keys that contradict each other.
/// kNoInput for a file it names that is not there. `where` names the text in errors; files are relative to
/// its folder. Pictures keep their names and are not read.
Result<Scene> parse_scene(std::string_view toml, const std::string& where);
/// The same with the pictures; in the library weft_scene_files.
Result<Scene> read_scene(const std::filesystem::path& file);

/// Whether a scene made in code is one that read_scene could have read.
Result<void> check_scene(const Scene& scene);

/// The scene as TOML with its defaults spelled out; parse_scene gives the same scene back, but for pictures.
/// Spectra and measured LEDs are written as numbers, pictures by their names.
std::string to_toml(const Scene& scene);

/// A combination of keys that makes no sense; for simulator/scene alone.
struct SceneRule {
  const char* key;  ///< the one that the rule speaks of, with dots
  bool (*is_broken)(const Scene&);
  const char* why;
  const char* remedy;
};

std::span<const SceneRule> scene_rules();

}  // namespace weft::simulator
