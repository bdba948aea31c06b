// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "solver/frame_fit/cell_fit.h"

namespace weft::solver {

/// Light that rises and falls from row to row of photographs, as that of a lamp does that flickers while the
/// shutter's slit goes over the sensor.
struct RowWaves {
  double period_rows = 0;         ///< of cells
  std::vector<double> amplitude;  ///< by photograph, of the first wave: a share of its light
  double sigma = 0;               ///< of an amplitude, by waves of other periods
  /// By photograph: its light over its mean, row by row of cells. Empty of one that does not flicker.
  std::vector<std::vector<float>> gain;
  /// Whether what is divided by them has the waves no more, and cloth has too little of near periods to hide
  /// what lamps have.
  bool are_even = false;
};

/// Looks for one period in errors that are the same in all columns: a weave's differ from column to column,
/// or lie in what albedo and tilt explain of the light of rows, to first order or as any lobe would, and its
/// multiples with it. Light that goes in step with yarns is told from them where it is much of theirs.
/// Periods of 3 rows of cells to a half of the frame are looked for. None where nothing is above kLeastWave
/// and its sigma. Photographs that are `strangers` to the others are not looked at.
inline constexpr double kLeastWave = 0.002;
std::optional<RowWaves> find_row_waves(const FrameCells& cells, const CellFit& fit,
                                       std::span<const std::size_t> strangers, int threads);

}  // namespace weft::solver
