// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "solver/transport/pixel_hash.h"

// Directions of cosine-weighted rays.

namespace weft::test {

/// A point of the unit square whose sides are joined: [0, 1) both.
struct TorusPoint {
  float u = 0, v = 0;
};

/// The rank-1 lattice {(i / R, frac(i a / R))} with the `a` that keeps its points farthest apart
/// (Niederreiter, "Random number generation and quasi-Monte Carlo methods", 1992, chapter 5).
///
/// Moved by a shift it estimates a mean without bias if shifts fall evenly on one cell of the lattice, as the
/// lattice repeats from cell to cell: no need to shift by up to the whole square (Cranley and Patterson
/// 1976). So point i of one pixel lies near point i of any other, and rays of neighbouring pixels make good
/// packets.
struct Lattice {
  std::vector<TorusPoint> points;
  std::array<TorusPoint, 2> cell;  ///< two short vectors that span a cell, negative parts allowed
};
Lattice make_lattice(int points);

/// The shift of a pixel: evenly spread over the cell around (0, 0).
inline TorusPoint shift_of(const Lattice& lattice, solver::PixelHash hash) {
  constexpr float kToUnit = 1.0f / (1U << 24);
  const float s = static_cast<float>(hash.first >> 8) * kToUnit - 0.5f;
  const float t = static_cast<float>(hash.second >> 8) * kToUnit - 0.5f;
  return {s * lattice.cell[0].u + t * lattice.cell[1].u, s * lattice.cell[0].v + t * lattice.cell[1].v};
}

}  // namespace weft::test
