// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "material/lattice/correlation.h"
#include "material/lattice/lattice.h"

namespace weft::material {

/// Directions of the two sets of yarns in degrees, 0 to 180 from +x.
struct YarnDirections {
  double first_deg = 0, second_deg = 90;
};

/// A yarn's own tone and thickness go on along it, so the correlations at whole repeats stand in a ridge
/// along each set: the directions whose repeats stand the most surely above their neighbours (Student's t).
/// Where one set shows none the other lies across it. Where none does, the slopes decide: a yarn is steep
/// across and level along, so their energy by direction, smoothed to its second and fourth harmonic, is
/// greatest across each set. A plain weave of perfect yarns deceives that by its diagonals.
YarnDirections yarn_directions(const Surface& surface, Rect crop, const Cell& cell,
                               const Correlations& correlations);

/// The two ways of a lattice that lie along the yarns: short, close to both directions and nearly upright to
/// each other. Four degrees off count as much as double the length.
Cell cell_along_yarns(const Cell& cell, const YarnDirections& yarns);

}  // namespace weft::material
