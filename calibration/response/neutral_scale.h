// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/base/result.h"

namespace weft::calibration {

/// One patch of the neutral scale of the Munsell system.
struct MunsellPatch {
  double value;        ///< N 9.5/ and so on
  double reflectance;  ///< luminous, of a perfect diffuser
};

/// The scale that is sold: N 9.5/, N 9/ to N 2/ in whole steps, 9 patches from light to dark.
std::span<const MunsellPatch> munsell_scale();

/// Luminous reflectance of a Munsell value from 0 to 10, 0 to 1, by the polynomial of fifth order of ASTM
/// D1535-14, equation 1 (of Newhall, Nickerson and Judd, JOSA 33, 1943, made relative to the perfect
/// diffuser).
double munsell_reflectance(double value);

/// How a photographed scale follows its reflectances.
struct ScaleCheck {
  /// v of reflectance 1 at the middle of the scale, by channel.
  std::array<double, 3> v_of_white = {};
  double shading = 0;               ///< of the light from the first to the last patch, relative
  std::vector<double> off_percent;  ///< of each patch: measured over expected, less 1; mean over channels
  double rms_percent = 0;
};

/// Fits log v = log(reflectance) + level of the channel + a parabola along the scale (LEDs stand near and to
/// one side) to the linear v of each patch, by least squares of patches above 1 percent of full scale. The
/// parabola takes up nearly all of a bent response: what is left speaks of the patches.
/// kBadData where fewer than five are; kUsage where the numbers differ.
Result<ScaleCheck> check_scale(std::span<const double> reflectances,
                               std::span<const std::array<double, 3>> linear_v);

}  // namespace weft::calibration
