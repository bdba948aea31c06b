// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "calibration/lights/paper_model.h"

namespace weft::calibration {

/// Photographs of a sheet of paper.
struct PaperPhotographs {
  PaperScene scene;
  std::vector<PaperReading> readings;
};

/// The photographs of a fit and `more` of them that nobody took: the sheet about where it lay in the first,
/// tilted by 20 degrees to sides a golden angle apart, with the readings that the scene itself would give
/// where it shows paper, as noisy as the others are (median). What they add to a fit's covariance is what
/// real ones would.
PaperPhotographs with_more_poses(const PaperScene& scene, std::span<const PaperReading> readings,
                                 const Sheet& sheet, int more);

}  // namespace weft::calibration
