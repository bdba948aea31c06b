// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct CalibrationMovedBenchOptions {
  int seeds = 50;  ///< sessions a case, 1 to 1000
  int threads = 0;
};

/// A rig of which nothing moved, its table 2 mm lower, its camera tilted by 0.3 degrees, one LED 5 mm away in
/// any direction, two LEDs exchanged, one LED at 97 percent: in how many sessions that is found, named
/// rightly, and nothing else invented, from rendered tags and white patches, and from a white sheet besides.
/// The calibration is off by its own uncertainty (0.3 mm, 0.2 degrees, 0.3 percent), LEDs drift and flicker,
/// the paper is not Lambertian. `asked` is the bar; costs are mean errors of normals (calibration::cost_of),
/// those of what was missed by the true lights.
Result<Rows> calibration_moved_table(const CalibrationMovedBenchOptions& options);

}  // namespace weft::bench
