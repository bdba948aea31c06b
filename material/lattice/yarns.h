// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "material/lattice/correlation.h"
#include "material/lattice/lattice.h"

namespace weft::material {

/// The two sets of yarns of a cloth.
struct Yarns {
  Cell along;                 ///< shortest repeats along the yarns, a the nearer one to +x
  double x_px = 0, y_px = 0;  ///< from yarn to yarn along `along.a`, and along `along.b`
  double share = 0;           ///< of the slopes' energy that goes on along either set
};

/// Of all pairs of ways of the lattice that are nearly upright to each other the one along which most of the
/// slopes' energy goes on. The mean of the correlation along a way is that energy's share (Wiener and
/// Khinchin): a yarn goes on along itself, with its section, its crimp and whatever its thickness does, while
/// along a diagonal hollows follow crests. Albedo has no vote, since prints and stripes go where they like.
/// Diagonals and yarns of one cloth may be close, so a pair beyond 30 degrees from the frame has to be half
/// as sure again.
///
/// Several yarns may lie in one row of the lattice, as in ribs and baskets: there the correlation also stands
/// high at whole parts of it.
///
/// Nothing where no pair is as somebody said.
std::optional<Yarns> find_yarns(const Cell& cell, const Correlations& correlations, const SaidYarns& said);

}  // namespace weft::material
