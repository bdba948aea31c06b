// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/image/image.h"
#include "core/image/raw_frame.h"

namespace weft::solver {

/// Rows and columns around a photosite that the demosaicing reads.
inline constexpr int kDemosaicReach = 2;

/// Fills in the two colours that each photosite of a mosaic did not measure, each from the two or four sites
/// next to it that did. How far the measured colour changes from the site to each of these neighbours is
/// known from the sites around.
/// - Where the missing colour changes along with it, as in grey and natural cloth, that change is taken off
///   (the gradient correction of Malvar, He and Cutler 2004).
/// - Where it does not, as between dyed yarns, the neighbours to which the measured colour does not change
///   count: those on the same side of an edge.
/// What lies between is mixed by the share of the neighbours' change that goes along. Nothing falls below 0
/// where no neighbour is.
///
/// `mosaic` is an image or a band of one; its (0, 0) has the phase of `cfa`. `area`, whose x0 is even, is the
/// part of it to fill; where `area` comes closer than kDemosaicReach to its edge the mosaic is mirrored about
/// the outermost site. (0, 0) of `rgb` is the area's corner; up to a row group is written past its last
/// column. A site that is not finite makes what is interpolated from it NaN or infinite.
void demosaic(View<const float> mosaic, const CfaPattern& cfa, Rect area,
              const std::array<View<float>, 3>& rgb);

/// The same for sites with independent errors of standard deviation `sigma`: changes within these errors
/// count as none. `sigma_rgb` gets the standard deviation of `rgb`: what the errors make of it, and beyond
/// three times that the disagreement of the neighbours it was mixed from.
void demosaic(View<const float> mosaic, View<const float> sigma, const CfaPattern& cfa, Rect area,
              const std::array<View<float>, 3>& rgb, const std::array<View<float>, 3>& sigma_rgb);

}  // namespace weft::solver
