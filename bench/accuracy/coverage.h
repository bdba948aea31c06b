// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "bench/accuracy/accuracy.h"
#include "bench/accuracy/accuracy_scenes.h"
#include "bench/base/study.h"
#include "core/base/result.h"
#include "solver/method.h"

namespace weft::bench {

/// What a sigma that is true has: a median of error over sigma from kLeastMedian to kMostMedian (it is 0.83
/// where the error is Gaussian with that rms angle) and under kMostBeyond of its pixels beyond 3 sigma.
inline constexpr double kLeastMedian = 0.7, kMostMedian = 1.4, kMostBeyond = 0.03;
/// Pixels with one of these bits are left out where they are not more than kMostFlagged of all.
inline constexpr std::uint16_t kNotCounted =
    kSaturated | kZeroDof | kIllConditioned | kSpecular | kInvalidReading;
inline constexpr double kMostFlagged = 0.2;

/// The error of a pixel's normal, the sigma stated for it, and its status.
struct StatedError {
  float error_deg = 0, sigma_deg = 0;
  std::uint16_t status = 0;
};

/// How often errors are as large as said: median of error over sigma, share beyond 3 sigma, and the same of
/// each tenth of the pixels by their sigma (the median farthest from 1, and the largest share), so that one
/// padded number cannot pass. "flagged": share of pixels with a bit of kNotCounted; "left_out": whether they
/// were. "holds": all of it is as kLeastMedian ... say; "each_tenth_holds": so are the medians of all tenths.
Json coverage_of(std::span<const StatedError> pixels);

/// The errors of a level on a patch, of all pixels with a solution in what is measured. A pixel of a preview
/// is held against the four it stands for.
Result<std::vector<StatedError>> stated_errors(const ClothPatch& patch, const solver::MethodName& level,
                                               int threads);

/// `normal_deg` of sigma.exr against the truth: a row for each scene and level, with coverage_of() both its
/// patches. `options.methods` names levels; empty: all five.
Result<Rows> coverage_table(const AccuracyTableOptions& options);

}  // namespace weft::bench
