// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/image/color_spaces.h"
#include "simulator/spectra/spectrum.h"
#include "simulator/targets/pattern.h"
#include "simulator/targets/sheet_waves.h"
#include "simulator/targets/target_settings.h"

// Calibration targets in the rig frame: what a camera's ray meets, in closed form.

namespace weft::simulator {

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

  /// Of the plane, towards the side that is printed.
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
