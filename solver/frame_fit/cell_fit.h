// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/vec.h"

// Whether each photograph fits the others: what is left of it where the others have told albedo and normal.

namespace weft::solver {

/// Readings of K photographs in cells that are spread over their whole frame: some columns, and in each all
/// rows.
struct FrameCells {
  int columns = 0, rows = 0;
  std::size_t count = 0;  ///< K
  /// Those of cell (x, y) in photograph k are at (y * columns + x) * K + k.
  std::vector<float> value;     ///< reading over strength; NaN: none
  std::vector<float> strength;  ///< reading of a white surface that faces the light
  std::vector<Vec3> direction;  ///< to the light, of unit length

  std::size_t cells() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  std::size_t cell_at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x);
  }
};

/// A light that gives less than this share of the third brightest is in shadow, or so aslant that it may be.
inline constexpr float kLitFrom = 0.25F;

/// What the lit readings of each cell tell together, and how each reading differs from what the others say.
struct CellFit {
  std::vector<Vec3> normal;       ///< by cell: albedo times normal; 0 where too few are lit
  std::vector<float> brightness;  ///< by cell: the third brightest of its values
  /// By reading: its value less what the others predict, over the brightness; NaN where there is none.
  std::vector<float> error;
  double sigma = 0;  ///< of lit errors, by their median
};

/// Whether photograph k shows a cell lit.
inline bool is_lit(const FrameCells& cells, const CellFit& fit, std::size_t cell, std::size_t k) {
  return cells.value[cell * cells.count + k] > kLitFrom * fit.brightness[cell];
}

/// Least squares by cell over the lit readings, those that do not fit counting less (Cauchy's weights, 3
/// sigma). A photograph that is wrong all over stays out of it where at least five others are right.
CellFit fit_cells(const FrameCells& cells, int threads);
/// The same with all lit readings counting alike, as least squares has it.
CellFit plain_fit(const FrameCells& cells, int threads);

/// By how much normals and albedo of two fits differ over cells that both have.
struct CellChange {
  double turned_deg = 0;  ///< rms
  double albedo = 0;      ///< median of the ratio less 1
};
CellChange change_of(const CellFit& from, const CellFit& to);

}  // namespace weft::solver
