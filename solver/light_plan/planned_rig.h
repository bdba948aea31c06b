// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/rig/lights.h"

namespace weft::solver {

/// What a rig is for somebody who thinks about its lights. Gains over the frame are not used.
struct ForeseenRig {
  std::vector<NearLight> leds;
  Vec3 camera_mm = {0, 0, 600};
  std::vector<Vec3> places_mm = {{0, 0, 0}};  ///< of the cloth, over the frame; the first is its middle
  double full_well_electrons = 40000, read_noise_electrons = 3;
  /// How far the LEDs may be off, (kLedErrors x LEDs)^2 by rows: by LED the log of its strength in the middle
  /// and, in radians, its direction from there along its two turns().
  std::vector<double> led_covariance;
};

inline constexpr std::size_t kLedErrors = 3;

/// A LED whose calibration says nothing of it: half a percent of its strength, and this far off.
inline constexpr double kTypicalGain = 0.005, kTypicalPosition_mm = 1;
/// What no LED is better known than: it drifts between calibration and scan, and the cloth is nowhere quite
/// at its height.
inline constexpr double kLeastGain = 0.005, kLeastTurn = 1e-4;

/// Two directions across the one from a point to a LED.
std::array<Vec3, 2> turns(Vec3 to_led);

/// The covariance of LEDs as they are typically known, each by itself.
std::vector<double> typical_led_covariance(const std::vector<NearLight>& leds, Vec3 middle_mm);

/// What the covariance of a calibration says of them in the middle. Of a LED that it does not name what is
/// typical. kBadData where it is none.
Result<std::vector<double>> led_covariance_of(const std::vector<NearLight>& leds, Vec3 middle_mm,
                                              const ParameterCovariance& covariance);

/// A place for a LED as seen from the middle of the cloth.
struct LedPlace {
  double from_camera_deg = 0;  ///< angle to the direction of the camera
  double azimuth_deg = 0;      ///< about it, from the rig's x axis

  friend bool operator==(const LedPlace&, const LedPlace&) = default;
};
LedPlace place_of(const ForeseenRig& rig, Vec3 position_mm);
/// A LED there: as far off as the rig's are, as bright and with their lobe (medians), aimed at the middle.
NearLight led_at(const ForeseenRig& rig, LedPlace place);

}  // namespace weft::solver
