// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "solve/photographs/photographs.h"

namespace weft::solve {

/// What each channel of RGB tells of the normal that the three share. A channel over its strength is x_c =
/// a_c (n . l) + e_c with albedo a_c and noise e_c of variance v_c, so that sum w_c x_c has the signal sum
/// w_c a_c and the variance sum w_c^2 v_c. Their ratio is largest for w_c = a_c / v_c, where the angle's
/// variance reaches the inverse of sum a_c^2 / v_c, that of all readings together.
///
/// a_c and v_c are medians over pixels of the sample tiles (solver/sample_tiles.h), each solved without
/// shadows and misfits: one set for the frame, the same for any tile and number of threads. Their sum is 1.
/// Luminance for mosaics, and where fewer than 100 pixels show a residual.
std::array<double, 3> measure_plane_weights(const Photographs& photographs);

}  // namespace weft::solve
