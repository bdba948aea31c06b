// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/base/vec.h"
#include "core/image/image.h"

// Shifts of the cloth between shots that are too large to be registered (registration.h) are searched for.

namespace weft::solver {

/// How the cloth of one shot lies against that of the others, in whole pixels: x to the right, y down.
struct FarShift {
  int dx_px = 0, dy_px = 0;
  /// Share of what the other shots leave unexplained of this one that undoing the shift takes away: 1 - z^2
  /// of the correlation z with what they predict. 0 where there is no shift.
  double explained = 0;
};

struct FarShifts {
  std::vector<FarShift> shots;  ///< by light; against where most shots show the cloth
  double explained = 0;         ///< the same of all shots together
  bool found = false;           ///< the shifts are evidence of a cloth that moved
};

/// A share of the frame's shorter side: no shift beyond it is looked for.
inline constexpr double kFarReach = 0.25;
/// What undoing the shifts takes away at least, of each shot that is said to have moved and of all together.
/// Gloss and shadows wander with the light and let a shift explain some of them.
inline constexpr double kFarExplained = 0.6;
/// And where most shots lie elsewhere.
inline constexpr double kFarExplainedOfAll = 0.8;

/// `shots` are readings over strength of one colour, in pictures of one size of about 48 to 256 pixels, not
/// finite where there is none; `lights` are unit directions, taken to be alike all over a picture.
///
/// What the other shots predict of each - least squares of b = rho n - is correlated with it at every shift
/// within reach, and it is laid where the correlation peaks, shot by shot, until none moves: once from where
/// the shots are, and if that finds nothing from shots placed one after the other. Means over 17 pixels are
/// taken off all pictures before, so that the fall of light does not count.
///
/// Lights that are not what they are said to be make each shot look shifted to a place of its own, by a part
/// of a weave's repeat; a cloth that is touched lies here before and there afterwards. So more is asked where
/// most shots lie elsewhere. Nothing is found from fewer than five lights.
FarShifts find_far_shifts(std::span<const Image<float>> shots, std::span<const Vec3> lights, int threads);

}  // namespace weft::solver
