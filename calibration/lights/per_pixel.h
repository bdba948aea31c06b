// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "calibration/lights/light_map.h"
#include "calibration/lights/paper_model.h"
#include "core/base/result.h"

namespace weft::calibration {

// The idea of seed 000 ("Light calibration"), intensity and direction for every pixel, made well posed. On
// one flat sheet a reading is one equation for three unknowns. With sheets in three poses or more it is
//   r'_j = n_j . b,   b = intensity * direction,
// where r'_j is reading j carried to the table along its line of sight: times what the model of the LED says
// on the table over what it says on sheet j. b of each cell is smoothed over the frame, the model is
// fitted to it, and all is done again until directions stay. The model goes only a part of the way that its
// fit asks for: all of it overshoots.

struct PerPixelOptions {
  double settled_deg = 0.01;  ///< the most any direction may still change
  int most_rounds = 60;
  int spline_columns = 6;  ///< of the smoothing
  int spline_rows = 4;
  int threads = 1;
};

/// Directions that differ so much from the model's say that the LED is not what the model says.
inline constexpr double kPartsFrom_deg = 0.3;

struct PerPixelLights {
  CellGrid grid;
  std::vector<LightMap> maps;  ///< of each LED, smoothed
  NearLights model;            ///< fitted to the maps; gains are those of the start
  std::vector<std::vector<double>>
      apart_deg;                    ///< by LED and cell: between the map's and the model's directions
  std::vector<double> changes_deg;  ///< the most that a direction changed, by round

  /// LEDs (from 0) whose maps part company with the model by more than kPartsFrom_deg anywhere.
  std::vector<std::size_t> parted() const;
};

/// `scene` has the poses and the paper as fit_lights() found them, and lights to start from. Errors: kBadData
/// where sheets lie in less than three directions, a LED has readings in too few cells, or directions do not
/// settle.
Result<PerPixelLights> solve_per_pixel(const PaperScene& scene, std::span<const PaperReading> readings,
                                       const CellGrid& grid, const PerPixelOptions& options = {});

}  // namespace weft::calibration
