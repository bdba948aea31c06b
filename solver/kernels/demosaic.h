// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/image.h"
#include "core/raw_frame.h"

namespace weft::solver {

/// Rows and columns around a photosite that the demosaicing reads.
inline constexpr int kDemosaicReach = 2;

/// Fills in the two colours that each photosite of a mosaic did not measure: gradient-corrected linear
/// interpolation (Malvar, He and Cutler 2004, fig. 2), whose weights are right where the channels are
/// balanced, as albedo and readings over strength are. `mosaic` is an image or a band of one; its (0, 0) has
/// the phase of `cfa`. `area`, whose x0 is even, is the part of it to fill; where `area` comes closer than
/// kDemosaicReach to its edge the mosaic is mirrored about the outermost site. (0, 0) of `rgb` is the area's
/// corner; up to a row group is written past its last column. A site that is not finite makes what is
/// interpolated from it NaN or infinite.
void demosaic(View<const float> mosaic, const CfaPattern& cfa, Rect area,
              const std::array<View<float>, 3>& rgb);

/// Standard deviation of what `demosaic` makes of sites with independent errors of standard deviation
/// `sigma`.
void demosaic_sigma(View<const float> sigma, const CfaPattern& cfa, Rect area,
                    const std::array<View<float>, 3>& rgb);

}  // namespace weft::solver
