// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/solve/verdict.h"
#include "solve/photographs/photographs.h"

namespace weft::solve {

/// How full photographs are: shares of the readings of all lights.
struct Fullness {
  double full = 0;     ///< saturated
  double missing = 0;  ///< no readings at all, as outside a mask
  double lit = 0;      ///< above 0
  /// Share of the way from black to white that one photosite in ten thousand exceeds, in the brightest frame
  /// or bracket. None of developed photographs, whose white nobody knows.
  std::optional<double> brightest = {};
};

/// From every 16th pair of rows of each photograph.
Fullness fullness_of(const Photographs& photographs);

/// Photographs are called over from this share of readings that are full, or of pixels that have no solution
/// for it.
inline constexpr double kMostFull = 0.1;
inline constexpr double kMostLost = 0.01;
/// And dark where their brightest places stay below this share of white, two stops under a metered exposure,
/// and noise turns half of the normals by more than this.
inline constexpr double kDarkBelow = 0.2;
inline constexpr double kDarkNoise_deg = 1;

/// OVEREXPOSED or UNDEREXPOSED, if they are. `lost` is the share of pixels without a solution that have a
/// full reading, `noise_deg` the median angle that noise turns the normals by.
std::optional<Verdict> exposure_verdict(const Fullness& fullness, double lost, double noise_deg,
                                        bool of_session);

/// What a solve without any solved pixel ends with.
Error nothing_solved(const std::string& where, Size size, const Fullness& fullness, bool of_session);

}  // namespace weft::solve
