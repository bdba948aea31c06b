// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

// Colours as numbers: linear Rec.709, CIE XYZ, xyY and L*a*b*, and the distance between two of them.

namespace weft {

using Rgb = std::array<double, 3>;  ///< linear; 1 is a perfect white
using Xyz = std::array<double, 3>;  ///< Y of a perfect white is 1
using Xyy = std::array<double, 3>;  ///< x, y, Y

/// CIE L*a*b*, white at (100, 0, 0).
struct Lab {
  double L = 0, a = 0, b = 0;
};

inline constexpr Xyz kWhiteD65 = {0.95047, 1, 1.08883};  ///< 2 degrees (IEC 61966-2-1)
inline constexpr Xyz kWhiteD50 = {0.96422, 1, 0.82521};  ///< 2 degrees (ICC.1)

/// Primaries of ITU-R BT.709 and white D65. Colours outside Rec.709 have channels below 0.
Xyz xyz_of_rec709(const Rgb& rgb);
Rgb rec709_of_xyz(const Xyz& xyz);
/// Inverse of the transfer function of IEC 61966-2-1, for display values from 0 to 1.
Rgb rec709_of_srgb(const Rgb& display);
/// And the function itself, clamped to 0 to 1.
Rgb srgb_of_rec709(const Rgb& rgb);

/// CIE 15:2004. The straight part of the curve goes on below 0.
Lab lab_of_xyz(const Xyz& xyz, const Xyz& white);
Xyz xyz_of_lab(const Lab& lab, const Xyz& white);
inline Lab lab_of_rec709(const Rgb& rgb) {
  return lab_of_xyz(xyz_of_rec709(rgb), kWhiteD65);
}
/// Linear Rec.709 of a colour measured under D50, adapted to D65 by Bradford's cone responses (ICC.1:2010,
/// annex E).
Rgb rec709_of_lab_d50(const Lab& lab);

/// Black has the chromaticity of white.
Xyy xyy_of_xyz(const Xyz& xyz);
/// A y that is not above 0 gives black.
Xyz xyz_of_xyy(const Xyy& xyy);

/// CIEDE2000 with kL = kC = kH = 1, as written out by Sharma, Wu and Dalal ("The CIEDE2000 color-difference
/// formula", Color Research and Application 30(1), 2005, equations 2 to 22).
double ciede2000(const Lab& first, const Lab& second);

}  // namespace weft
