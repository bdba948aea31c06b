// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "core/base/result.h"
#include "simulator/targets/pattern.h"
#include "simulator/targets/target_settings.h"

// Paper as it is: not quite flat, not quite even.

namespace weft::simulator {

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

}  // namespace weft::simulator
