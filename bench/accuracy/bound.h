// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct BoundOptions {
  std::vector<std::string> methods;  ///< empty: all that solve mosaics
  int threads = 0;
};

/// Scatter of one green photosite at the table's centre under photon and read noise alone, at the exposure
/// for white: albedo 0.04, 0.2 and 0.9, tilted by 0, 20 and 45 degrees to all sides. LEDs that the surface
/// does not face are marked as shadowed for every method. A row for each case and method:
/// ratio_to_bound: rms angle over that of the Cramer-Rao bound.
/// within_68: share of pixels with chi-square below 2.28, the 68 percent point for two degrees of freedom.
/// Methods state an rms angle and no directions, so chi-square takes its size from the method's own sigma and
/// its shape from the bound's tangent covariance, which weighted least squares attains.
Result<Rows> accuracy_bound(const BoundOptions& options);

}  // namespace weft::bench
