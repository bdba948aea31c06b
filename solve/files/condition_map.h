// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/image/compression.h"
#include "solve/photographs/photographs.h"
#include "solver/in_double/pixel.h"

namespace weft::solve {

/// What stands for lights that do not span three directions: double tells no condition number from infinity
/// there.
inline constexpr double kMostDecades = 16;

/// The logarithm to base 10 of the condition number of the lights that are left, at most kMostDecades.
double condition_decades(std::span<const solver::PixelRow> rows,
                         std::span<const solver::ReadingStory> stories);

/// Writes condition.exr: by pixel condition_decades() of the readings that the method keeps, each pixel by
/// itself in double. Reports the phase "condition".
Result<void> write_condition_map(const Photographs& photographs, const std::string& method,
                                 const std::filesystem::path& file, Compression compression,
                                 const JobContext& context);

}  // namespace weft::solve
