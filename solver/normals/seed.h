// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "core/base/vec.h"
#include "solver/in_double/pixel.h"

namespace weft::solver {

/// The four solutions N = k_d n of one pixel: red, green, blue and luminance (Neubelt and Pettineo 2013, eq.
/// 26-28).
struct SeedPixel {
  std::array<Vec3, 4> n;  ///< not normalised: the length is the albedo
  std::array<bool, 4> solved = {};
};

/// Solves L N = I four times by Eigen's two-sided Jacobi SVD in double (eq. 29 and the text below it). Each
/// system holds the readings that are valid in its own channel, the fourth those valid in all three.
SeedPixel solve_seed_pixel(std::span<const PixelRow> rows);

}  // namespace weft::solver
