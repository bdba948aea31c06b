// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/image/image.h"

namespace weft::capture {

/// The black level of a DNG on its active area: a pattern that repeats, and differences from column to column
/// and from row to row (Digital Negative Specification 1.4: BlackLevel, BlackLevelRepeatDim, BlackLevelDeltaH
/// and V).
class DngBlack {
 public:
  DngBlack() = default;
  /// `pattern` by rows of `columns`. Differences: one a column or row of the active area, or none.
  DngBlack(std::vector<double> pattern, std::size_t columns, std::vector<double> by_column,
           std::vector<double> by_row);

  /// Counts, [y & 1][x & 1]: the mean over all such photosites.
  const std::array<std::array<float, 2>, 2>& cell() const { return cell_; }

  /// Takes from the active area's counts what they differ in from the cell, to whole counts: then the cell
  /// holds for each. Those from `white` on stay, so that what is full stays full.
  void level(View<std::uint16_t> counts, float white) const;

 private:
  double pattern_at(std::size_t x, std::size_t y) const;

  std::vector<double> pattern_ = {0}, by_column_, by_row_;
  std::size_t columns_ = 1;
  std::array<std::array<float, 2>, 2> cell_ = {};
};

}  // namespace weft::capture
