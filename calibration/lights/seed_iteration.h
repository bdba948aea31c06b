// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "calibration/lights/light_map.h"
#include "calibration/lights/paper_model.h"
#include "core/base/result.h"

namespace weft::calibration {

// The iteration of seed 000 ("Light calibration") on one flat sheet, as the paper has it: with directions
// from measured positions, intensity i = I / l_z in every cell, filtered; with that intensity a new
// direction, l_z = I / i at the azimuth it had; and again. One equation for two unknowns: where nothing is
// filtered, every start is a fixed point, and where it is, what the filter takes from the intensity goes into
// the direction. The paper solves ever flatter and the directions are no better for it, which the steps below
// show.

struct SeedOptions {
  int iterations = 5;
  double filter_cells = 1;  ///< standard deviation of the filter of intensities; 0 filters nothing
};

/// What one iteration did, over all LEDs and cells.
struct SeedStep {
  double direction_change_deg = 0;  ///< mean angle to the directions before it
  double intensity_change = 0;      ///< rms, relative to the intensities before it
  double paper_residual_deg = 0;    ///< rms angle between z and the normal that the lights solve the paper to
};

struct SeedLights {
  CellGrid grid;
  std::vector<LightMap> maps;   ///< of each LED, after the last iteration
  std::vector<SeedStep> steps;  ///< the first is the start: positions as measured, intensities from the paper
};

/// `start` has the LEDs where they were measured; readings of its sheet 0 alone are used and that sheet is
/// taken as level. kBadData where less than three LEDs light a cell anywhere.
Result<SeedLights> iterate_seed(const PaperScene& start, std::span<const PaperReading> readings,
                                const CellGrid& grid, const SeedOptions& options = {});

/// The nearest that NearLights come to the maps of the iteration: LEDs where they were measured, shining
/// evenly to all sides, each with the flux and the quadratic log gain that fit its intensities best.
/// Directions are those of the start.
NearLights lights_of(const SeedLights& seed, const PaperScene& start);

}  // namespace weft::calibration
