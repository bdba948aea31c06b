// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/result.h"
#include "core/image/image.h"

namespace weft::material {

/// Slopes that belong to no surface, from this median on: perfect cloth has 0.8 to 2.3, a painted normal
/// map 19.
inline constexpr double kCurlLimit = 3;

struct CurlOptions {
  double yarn_px = 0;  ///< pitch of the yarns; the window is 1.3 of them. 0: not known, 25 pixels
  /// What a slope is trusted to where there is no map of sigma: of a normal, degrees; 0.3 suits 8-bit maps.
  double usual_sigma_deg = 0.2;
  bool is_tile = false;
  int threads = 0;  ///< 0: all the machine has. Changes no byte
};

struct Curl {
  Image<float> median;      ///< of |z| in the window about each pixel, to kCurlStep; 0 where nothing is known
  int window_px = 0;        ///< its side, odd
  double frame_median = 0;  ///< of |z| over the frame: 0.67 if sigma is all that is wrong
  double flagged_share = 0;  ///< of the pixels where something is known, those with a median above kCurlLimit
  /// Shares of the flagged pixels that the solve calls SPECULAR and SHADOWED: the likely causes.
  double specular_share = 0, shadowed_share = 0;

  bool is_of_no_surface() const { return frame_median > kCurlLimit; }
};
/// Medians are counted in bins of this width, up to 64.
inline constexpr double kCurlStep = 1.0 / 16;

/// How far slopes (right, and up the picture; mm a mm) are from those of any surface.
///
/// The circulation around each 2 x 2 pixels by trapezoids is 0 on a surface. With p to the right, q down,
///     C = ((p00 + p10) + (q10 + q11) - (p01 + p11) - (q00 + q01)) / 2,   indices column, row,
/// its variance half the sum of the four pixels' slope variances (sigma / (sqrt 2 n_z^2))^2, and z = C /
/// sigma_C. The median of |z| over a window and not the rms: creases between yarns make a tenth of |z| exceed
/// 5 on perfect cloth. `sigma_deg` (rms angle of the normal) and `status` may be empty; squares with a pixel
/// of kNoSolution, or that is not finite, have no part.
///
/// kUsage for shapes that differ and options out of range.
Result<Curl> curl(View<const float> right, View<const float> up, View<const float> sigma_deg,
                  View<const std::uint16_t> status, const CurlOptions& options);

}  // namespace weft::material
