// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "material/lattice/lattice.h"
#include "tests/material/weave.h"

namespace weft::material {

/// What a lattice misses of the weave that it was found in.
struct LatticeError {
  double yarns_of_cell = 0;         ///< the cell's area in crossings
  double yarns_of_colour_cell = 0;  ///< as much of the colours' cell
  double px_a_yarn = 0;             ///< farthest way, by the yarns it spans
  double turn_deg = 0;
  double yarn_px = 0;  ///< of the widths of both sets
};

inline LatticeError error_of(const Lattice& lattice, const WeaveSettings& weave) {
  const double c = std::cos(radians(weave.turn_deg)), s = std::sin(radians(weave.turn_deg));
  const double crossing = weave.pitch_x_px * weave.pitch_y_px;
  LatticeError error = {lattice.weave.area() / crossing, lattice.colour.area() / crossing};
  for (const Vec2 way : {lattice.weave.a, lattice.weave.b, lattice.colour.a, lattice.colour.b}) {
    const double x = (c * way.x + s * way.y) / weave.pitch_x_px,
                 y = (c * way.y - s * way.x) / weave.pitch_y_px;
    const double off =
        std::hypot((x - std::round(x)) * weave.pitch_x_px, (y - std::round(y)) * weave.pitch_y_px);
    error.px_a_yarn = std::max(error.px_a_yarn, off / std::max({1.0, std::abs(x), std::abs(y)}));
  }
  const auto off_deg = [](double a, double b) { return std::abs(std::remainder(a - b, 90.0)); };
  error.turn_deg =
      std::max(off_deg(lattice.turn_x_deg, weave.turn_deg), off_deg(lattice.turn_y_deg, weave.turn_deg));
  error.yarn_px = std::max(std::abs(lattice.yarn_x_px - weave.pitch_x_px),
                           std::abs(lattice.yarn_y_px - weave.pitch_y_px));
  return error;
}

}  // namespace weft::material
