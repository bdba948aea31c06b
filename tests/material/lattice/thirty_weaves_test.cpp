// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <numeric>
#include <string>

#include "tests/material/lattice/lattice_case.h"

namespace weft::material {
namespace {

// Ten weaves, each without stripes, with stripes of 4 and of 6 yarns; 1024 x 1024 pixels, wander of up to 5
// percent, pulls of up to 2 pixels. Prints what docs/finishing.md tells.
TEST(ThirtyWeaves, HaveTheirCellsAndColours) {
  const WeaveSettings weaves[] = {
      {.pitch_x_px = 21.6, .pitch_y_px = 21.6, .turn_deg = 1.9},
      {.pitch_x_px = 21.6, .pitch_y_px = 21.6, .turn_deg = 1.9, .wander = 0.03},
      {.pitch_x_px = 12.3, .pitch_y_px = 10.1, .turn_deg = -3.2, .wander = 0.05},
      {.binding = kTwill, .pitch_x_px = 14.2, .pitch_y_px = 14.2, .turn_deg = 0.41, .wander = 0.05},
      {.binding = kTwill31,
       .pitch_x_px = 9.7,
       .pitch_y_px = 13.1,
       .turn_deg = 2.2,
       .wander = 0.05,
       .warp_px = 1},
      {.binding = kSatin5, .pitch_x_px = 11.3, .pitch_y_px = 13.7, .turn_deg = 0.83, .wander = 0.03},
      {.binding = kSatin5,
       .pitch_x_px = 11.3,
       .pitch_y_px = 13.7,
       .turn_deg = 0.83,
       .wander = 0.05,
       .warp_px = 2},
      {.binding = kSatin8,
       .pitch_x_px = 8.1,
       .pitch_y_px = 8.9,
       .turn_deg = -1.1,
       .wander = 0.05,
       .warp_px = 1},
      {.pitch_x_px = 6.2, .pitch_y_px = 6.2, .turn_deg = 5.7, .wander = 0.05, .warp_px = 1},
      {.pitch_x_px = 9.1, .pitch_y_px = 7.3, .turn_deg = 27, .wander = 0.05, .warp_px = 0.5},
  };
  int right_cells = 0, right_colours = 0;
  for (WeaveSettings weave : weaves) {
    for (const int stripe : {0, 4, 6}) {
      weave.stripe_yarns = stripe;
      const Result<Lattice> lattice = find_lattice(weave_surface(weave, {1024, 1024}));
      ASSERT_TRUE(lattice) << lattice.error().message();
      const LatticeError error = error_of(*lattice, weave);
      const int period = weave.binding.period();
      // The weave's own cell and the stripes' way along x have this area in common.
      const int striped = stripe == 0 ? period : 2 * stripe * period;
      const bool is_right =
          lattice->kind == LatticeKind::kRepeat && std::lround(error.yarns_of_cell) == period;
      const bool has_colours = std::lround(error.yarns_of_colour_cell) == striped;
      right_cells += is_right;
      right_colours += has_colours;
      std::printf(
          "%-9s %4.1f x %4.1f px, wander %.2f, pull %.1f, stripes %d: cell %.2f of %d, colours %.2f of %d, "
          "%.4f px a yarn, %.3f deg, strength %.2f, t %.1f\n",
          weave.binding.name, weave.pitch_x_px, weave.pitch_y_px, weave.wander, weave.warp_px, stripe,
          error.yarns_of_cell, period, error.yarns_of_colour_cell, striped, error.px_a_yarn, error.turn_deg,
          lattice->strength, lattice->sublattice_t);
      if (is_right) {
        EXPECT_LT(error.px_a_yarn, 0.02);
        EXPECT_LT(error.turn_deg, 0.05);
      }
    }
  }
  std::printf("right cells: %d of 30, right colour cells: %d of 30\n", right_cells, right_colours);
  EXPECT_GE(right_cells, 28);
}

}  // namespace
}  // namespace weft::material
