// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "core/vec.h"

// A scene says what is on the table, what lights it, what photographs it and which effects are simulated.
// docs/scenes.md lists every key; millimetres and the rig frame throughout.

namespace weft::simulator {

/// Linear Rec.709 red, green, blue.
using Rgb = std::array<double, 3>;

/// The made-up camera bodies, by how they store no light.
enum class Body {
  kOffset,  ///< black at 600 counts, so that noise below it survives; white at 15520
  kD5100,   ///< black subtracted and clipped at 0, as a Nikon D5100 does; white at 15846
};

struct CameraSettings {
  int width = 2464;  ///< photosites, even: whole filter cells
  int height = 1632;
  double mm_per_pixel = 0.08;  ///< on the table, z = 0
  double distance_mm = 600;    ///< from the table to the projection centre, straight above it
  Body body = Body::kOffset;
  int bits = 14;                       ///< 12, 14 or 16; black and white scale with it
  double full_well_electrons = 40000;  ///< electrons of a photosite at white, at ISO 100
  double read_noise_electrons = 3;     ///< standard deviation
  double iso = 100;
  double f_number = 8;  ///< recorded; the flux of the LEDs is what arrives through it
  std::optional<double> exposure_us;
  /// Without exposure_us: the albedo that, at the table's centre and facing a LED, gives 0.90 of full scale
  /// in the brightest channel of the brightest LED.
  double albedo_at_full = 0.99;

  bool operator==(const CameraSettings&) const = default;
};

enum class GeometryKind { kFlat, kTilted, kPlain, kTwill, kSatin };
inline bool is_woven(GeometryKind kind) {
  return kind != GeometryKind::kFlat && kind != GeometryKind::kTilted;
}

/// The shape of the cloth. Lengths without unit are in yarn pitches, so that slopes do not depend on scale.
struct GeometrySettings {
  GeometryKind kind = GeometryKind::kFlat;
  double cloth_height_mm = 0;  ///< of the plane that the cloth's heights are measured from, above the table

  double tilt_deg = 20;    ///< kTilted: between the normal and z
  double azimuth_deg = 0;  ///< kTilted: of the normal's horizontal part, from x towards y

  double warp_pitch_mm = 0.5;  ///< from one warp yarn (along y) to the next
  double weft_pitch_mm = 0.5;  ///< from one weft yarn (along x) to the next
  /// Warp yarn i lies over weft yarn j where (j - step * i) mod (over + under) < over.
  std::optional<int> over;   ///< else 1, 2, 4 for plain, twill, satin
  std::optional<int> under;  ///< else 1, 2, 1
  std::optional<int> step;   ///< else 1, 1, 2
  double crimp = 0.08;       ///< amplitude of a yarn's axis as it goes over and under
  double flank_deg =
      36;  ///< slope of a yarn's flank where it meets its neighbour, half a pitch from its axis
  double twist_relief = 0;  ///< amplitude of the ridges that the plies of a yarn make

  bool operator==(const GeometrySettings&) const = default;
};

struct MaterialSettings {
  Rgb albedo = {0.5, 0.5, 0.5};
  std::optional<Rgb> warp_albedo;  ///< instead of `albedo` for the warp
  std::optional<Rgb> weft_albedo;  ///< instead of `albedo` for the weft
  /// 0: the warp has one colour and the weft the other. n: both sets have n yarns of one, then n of the
  /// other.
  int stripe_yarns = 0;
  double yarn_variation = 0;  ///< albedo of a yarn is multiplied by 1 +- this, uniformly

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

struct LightSettings {
  double flux = 2e7;                   ///< of the green channel: reading * mm^2 / s at ISO 100
  Rgb white_balance = {0.5, 1, 0.68};  ///< flux by channel is `flux` times this
  double mu = 1;                       ///< lobe exponent: 0 isotropic, 1 Lambertian
  /// LED 1 is the first of the first ring; `leds` follow the rings. With neither there are the
  /// default_rings().
  std::vector<LedRing> rings;
  std::vector<LedSettings> leds;

  bool operator==(const LightSettings&) const = default;
};

/// What is simulated beyond the ideal picture. An effect that a scene does not name does not run.
struct EffectSettings {
  bool near_light =
      false;            ///< direction, distance and lobe of each LED by pixel; else as at the table's centre
  bool relief = false;  ///< light is evaluated at the cloth's height, else on the plane cloth_height_mm
  bool noise = false;   ///< photon noise and read noise

  bool operator==(const EffectSettings&) const = default;
};

struct Scene {
  std::string fabric = "simulated cloth";
  std::int64_t seed = 1;  ///< of all random numbers, from 0
  CameraSettings camera;
  GeometrySettings geometry;
  MaterialSettings material;
  LightSettings lights;
  EffectSettings effects;

  bool operator==(const Scene&) const = default;
};

/// Reads a scene in TOML. An unknown key is kBadData with its line and the nearest key that exists; so is a
/// value of the wrong type or out of its range, with what is allowed. `where` names the text in errors.
Result<Scene> parse_scene(std::string_view toml, const std::string& where);
Result<Scene> read_scene(const std::filesystem::path& file);

/// Whether a scene made in code keeps the ranges that parse_scene enforces.
Result<void> check_scene(const Scene& scene);

/// The scene as TOML with its defaults spelled out; parse_scene gives the same scene back.
std::string to_toml(const Scene& scene);

}  // namespace weft::simulator
