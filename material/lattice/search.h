// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "material/lattice/correlation.h"
#include "material/lattice/lattice.h"

// The steps of find_lattice().

namespace weft::material {

/// The same lattice by its shortest ways (Gauss), a the one that lies nearest to +x.
Cell reduced(Cell cell);

/// The pair of peaks with the smallest area among those whose multiples are peaks too, in each of the slopes
/// that repeat.
std::optional<Cell> first_cell(const Correlations& correlations, const Correlation& mean);

/// A cell and how well peaks in reach agree with it.
struct RefinedCell {
  Cell cell;
  double residual_px = 0;
  int points = 0;
};
RefinedCell refined(const Cell& cell, const Correlation& mean);

/// A sublattice by its Hermite form: (i, j) belongs to it where j is a multiple of `down` and i - shift j /
/// down one of `across`.
struct Sublattice {
  int across = 1, shift = 0, down = 1;
  bool has(int i, int j) const;
  Cell of(const Cell& cell) const;
};

/// Student's t from which a sublattice is one.
inline constexpr double kSureOfSublattice = 12;

/// The sublattice whose points correlate the most surely above those beside them, and Student's t: of index
/// 2, or of the next one up to 8 where none is sure.
struct SublatticeTest {
  Sublattice best;
  double t = 0;
};
SublatticeTest test_sublattices(const Cell& cell, std::span<const Correlation* const> slopes);

/// The smallest sublattice of up to 16 x 16 repeats on which colours repeat too. `along` are ways along the
/// yarns: repeats there say nothing, since a yarn keeps its tone.
std::optional<Sublattice> colour_sublattice(const Cell& cell, const Cell& along,
                                            const Correlation& luminance);

/// Ribs: where the correlation stays high along one way, the shortest repeat across it.
std::optional<Vec2> repeat_of_ribs(std::span<const Correlation* const> slopes,
                                   std::span<const double> levels);

}  // namespace weft::material
