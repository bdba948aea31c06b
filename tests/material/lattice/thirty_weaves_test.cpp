// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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

// Cloths whose yarns colours, prints and plies hide, and yarns without any mark of their own. Prints the
// worst of each, which docs/finishing.md tells.
TEST(PlainWeaves, LieAlongTheirYarnsHoweverTheyAreColouredAndTurned) {
  struct Cloth {
    const char* name;
    WeaveSettings weave;
  };
  const Cloth cloths[] = {
      {"all yarns alike", {.tone = 0}},
      {"all yarns alike, 11.4", {.pitch_y_px = 11.4, .tone = 0}},
      {"faint tone", {.pitch_x_px = 9, .pitch_y_px = 8.4, .tone = 0.02}},
      {"plied", {.twist = 0.012}},
      {"striped", {.pitch_x_px = 10, .pitch_y_px = 9, .stripe_yarns = 6}},
      {"gingham", {.pitch_x_px = 10, .pitch_y_px = 9, .tone = 0, .stripe_yarns = 6, .is_check = true}},
      {"check", {.pitch_x_px = 10, .pitch_y_px = 10, .stripe_yarns = 4, .stripe_other = 2, .is_check = true}},
      {"broad check", {.pitch_x_px = 12, .pitch_y_px = 10, .stripe_yarns = 8, .is_check = true}},
      {"printed", {.pitch_x_px = 9.3, .pitch_y_px = 8.9, .print_px = {118, 106}}},
      {"printed, alike", {.pitch_x_px = 10, .pitch_y_px = 10, .tone = 0, .print_px = {80, 80}}},
      {"rib 2/2", {.binding = kRib22, .tone = 0}},
      {"rib 2/1", {.binding = kRib21, .pitch_x_px = 11, .pitch_y_px = 9, .tone = 0}},
      {"basket", {.binding = kBasket, .pitch_x_px = 10, .pitch_y_px = 10}},
      {"worn", {.wander = 0.04, .noise_deg = 3, .warp_px = 1}},
      {"low crimp", {.tone = 0, .crimp = 0.02}},
  };
  bool is_even = true;
  for (const Cloth& cloth : cloths) {
    LatticeError worst;
    is_even = !is_even;
    for (const double turn_deg : is_even ? std::array{0.0, 25.0} : std::array{1.4, 8.0}) {
      WeaveSettings weave = cloth.weave;
      weave.turn_deg = turn_deg;
      const Result<Lattice> lattice = find_lattice(weave_surface(weave, {448, 448}));
      ASSERT_TRUE(lattice) << lattice.error().message();
      const LatticeError error = error_of(*lattice, weave);
      EXPECT_EQ(lattice->kind, LatticeKind::kRepeat) << cloth.name << " at " << turn_deg;
      EXPECT_LT(error.turn_deg, 0.05) << cloth.name << " at " << turn_deg << ": " << lattice->turn_x_deg;
      EXPECT_LT(error.yarn_px, 0.02) << cloth.name << " at " << turn_deg << ": " << lattice->yarn_x_px
                                     << " x " << lattice->yarn_y_px;
      worst.turn_deg = std::max(worst.turn_deg, error.turn_deg);
      worst.yarn_px = std::max(worst.yarn_px, error.yarn_px);
    }
    std::printf("%-22s %.4f deg, %.4f px a yarn\n", cloth.name, worst.turn_deg, worst.yarn_px);
  }
}

}  // namespace
}  // namespace weft::material
