// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/image/color_spaces.h"
#include "simulator/spectra/spectrum.h"
#include "simulator/targets/pattern.h"
#include "simulator/targets/target_settings.h"

// Calibration targets in the rig frame: what a camera's ray meets, in closed form.

namespace weft::simulator {

// Paper as it is: not quite flat, not quite even.

/// How a sheet departs from a plane of even albedo at a spot.
struct SheetPoint {
  double height_mm = 0;  ///< over its plane
  double slope_u = 0;    ///< of height along u
  double slope_v = 0;
  double brightness = 1;  ///< the albedo is multiplied by this
};

/// Waves are sines in directions all around, wavelengths within a factor of 1.4 of the one asked for; they
/// have slopes of rms tan(waviness_deg). Grains are squares, each with an albedo and a slope of its own drawn
/// uniformly; a spot sees the mean of those that its box covers, by area. A box wider than 4 grains sees
/// grains of twice the size and half the strength, or of 4 times and a quarter, which has the same variance.
class PaperSheet {
 public:
  /// `number` is that of the target in its scene: targets of one seed differ.
  PaperSheet(const SheetSettings& settings, std::int64_t seed, int number);
  SheetPoint at(const TargetSpot& spot) const;

 private:
  struct Wave {
    double k_u, k_v;  ///< radians / mm
    double amplitude_mm;
    double phase;
  };
  void add_waves(const TargetSpot& spot, SheetPoint& point) const;
  void add_grain(const TargetSpot& spot, SheetPoint& point) const;

  static constexpr int kWaves = 12;
  std::array<Wave, kWaves> waves_{};
  double grain_mm_;
  double grain_albedo_;  ///< rms
  double grain_slope_;   ///< rms along u, and along v
  std::array<std::uint32_t, 2> key_;
  std::uint32_t number_;
};

/// f_p = 1 - delta (1 - n . l): what a sheet reflects over Lambert's law, for delta of SheetSettings.
inline double lambert_factor(double non_lambertian, double cosine) {
  return 1 - non_lambertian * (1 - cosine);
}

/// kBadData names a setting that is out of its range.
Result<void> check_sheet(const SheetSettings& settings);

/// A ray of the camera and how it turns from pixel to pixel (ray differentials; Igehy, SIGGRAPH 1999).
struct ViewRay {
  Vec3 origin_mm;
  Vec3 direction;  ///< of any length
  Vec3 per_x;      ///< change of `direction` to the next pixel of the row
  Vec3 per_y;      ///< and to the next row; with both 0 the pixel is a point
};

/// Where a ray meets a target.
struct TargetHit {
  TargetSpot spot;
  double distance_mm = 0;  ///< from the ray's origin: of several targets the nearest is seen
};

/// What is there.
struct TargetPoint {
  Vec3 point_mm;  ///< rig frame, on the waves of the sheet
  Vec3 normal;
  double brightness = 1;  ///< the albedo is Target::average times this
  double coverage = 1;    ///< share of the pixel; the rest shows what lies behind
};

/// A sheet on the table as rays meet it.
class Target {
 public:
  /// `number` is that of the target in its scene, from 0: its grain and waves depend on it and on the seed.
  /// kBadData names a setting that is out of its range.
  static Result<Target> make(const TargetSettings& settings, std::int64_t seed, int number);

  /// The plane's normal, towards the side that is printed.
  Vec3 normal() const { return normal_; }
  /// A point of the plane.
  Vec3 place_mm(double u_mm, double v_mm) const;
  double width_mm() const { return pattern_.width_mm(); }
  double height_mm() const { return pattern_.height_mm(); }
  double non_lambertian() const { return non_lambertian_; }

  /// Nothing if the ray passes the target by, comes from behind or leads away. The spot's box has the
  /// variance of the pixel's parallelogram along u and v, so that edges have their width and stay in place.
  /// Waves are too low to move where a ray meets the plane.
  std::optional<TargetHit> hit(const ViewRay& ray) const;
  TargetPoint at(const TargetSpot& spot) const;

  int ink_at(double u_mm, double v_mm) const { return pattern_.ink_at(u_mm, v_mm); }
  /// Mean albedo over the spot's box, for inks as inks_of() numbers them.
  Rgb average(const TargetSpot& spot, std::span<const Rgb> albedo_of_ink) const {
    return pattern_.average(spot, albedo_of_ink);
  }

 private:
  Target(const TargetSettings& settings, Pattern pattern, const PaperSheet& sheet);

  Pattern pattern_;
  PaperSheet sheet_;
  double non_lambertian_;
  Vec3 centre_mm_;
  Vec3 u_axis_, v_axis_, normal_;
};

/// Reflectances of a target's inks by number: white, black, then the patches of a scale or chart. `chart` has
/// the 24 patches of a ChartSettings, row by row from the upper left, and is not used by other kinds.
/// kBadData if it has not, or if a reflectance is not from 0 to 1.
Result<std::vector<Spectrum>> inks_of(const TargetSettings& settings, std::span<const Spectrum> chart);

}  // namespace weft::simulator
