// SPDX-License-Identifier: Apache-2.0
#include "material/lattice/lattice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "core/solve/solve_record.h"
#include "tests/material/lattice/lattice_case.h"
#include "tests/material/unwoven.h"

namespace weft::material {
namespace {

Lattice lattice_of(const Surface& surface, const LatticeOptions& options = {}) {
  const Result<Lattice> lattice = find_lattice(surface, options);
  EXPECT_TRUE(lattice) << lattice.error().message();
  return lattice ? *lattice : Lattice();
}

TEST(Lattice, IsTheWeavesWithinAFiftiethOfAPixelAYarn) {
  const std::array<WeaveSettings, 5> weaves = {{
      {.pitch_x_px = 12.3, .pitch_y_px = 10.1, .turn_deg = -3.2, .wander = 0.03},
      {.binding = kTwill, .pitch_x_px = 14.2, .pitch_y_px = 14.2, .turn_deg = 0.41, .wander = 0.03},
      {.binding = kSatin5,
       .pitch_x_px = 11.3,
       .pitch_y_px = 13.7,
       .turn_deg = 0.83,
       .wander = 0.05,
       .warp_px = 1},
      {.binding = kSatin8, .pitch_x_px = 8.1, .pitch_y_px = 8.9, .turn_deg = -1.1, .wander = 0.02},
      {.pitch_x_px = 9.1, .pitch_y_px = 7.3, .turn_deg = 27, .wander = 0.04},
  }};
  for (const WeaveSettings& weave : weaves) {
    const Lattice lattice = lattice_of(weave_surface(weave, {640, 640}));
    const LatticeError error = error_of(lattice, weave);
    EXPECT_EQ(lattice.kind, LatticeKind::kRepeat) << weave.binding.name;
    EXPECT_EQ(std::lround(error.yarns_of_cell), weave.binding.period()) << weave.binding.name;
    EXPECT_EQ(std::lround(error.yarns_of_colour_cell), weave.binding.period()) << weave.binding.name;
    EXPECT_FALSE(lattice.colours_repeat) << weave.binding.name;
    EXPECT_LT(error.px_a_yarn, 0.02) << weave.binding.name;
    EXPECT_LT(error.turn_deg, 0.05) << weave.binding.name;
    EXPECT_NEAR(lattice.yarn_x_px, weave.pitch_x_px, 0.02) << weave.binding.name;
    EXPECT_NEAR(lattice.yarn_y_px, weave.pitch_y_px, 0.02) << weave.binding.name;
  }
}

TEST(Lattice, LiesAlongTheYarnsAndNotAlongTheTwillsLine) {
  const WeaveSettings weave = {
      .binding = kTwill, .pitch_x_px = 10, .pitch_y_px = 11, .turn_deg = 2, .wander = 0.03};
  const Lattice lattice = lattice_of(weave_surface(weave, {512, 512}));
  EXPECT_NEAR(length(lattice.axes.a), 40, 0.1);
  EXPECT_NEAR(length(lattice.axes.b), 44, 0.1);
  EXPECT_NEAR(lattice.turn_x_deg, 2, 0.05);
  EXPECT_NEAR(lattice.turn_y_deg, 2, 0.05);
}

TEST(Lattice, LiesAlongTheYarnsWhereColoursAndPliesDoNot) {
  const WeaveSettings cloths[] = {
      {.pitch_x_px = 12, .pitch_y_px = 12, .turn_deg = 1.4, .tone = 0},
      {.pitch_x_px = 10, .pitch_y_px = 9, .turn_deg = 0, .stripe_yarns = 6, .is_check = true},
      {.pitch_x_px = 12, .pitch_y_px = 12, .turn_deg = 8, .twist = 0.012},
      {.pitch_x_px = 10, .pitch_y_px = 10, .turn_deg = 25, .tone = 0, .print_px = {80, 80}},
  };
  for (const WeaveSettings& weave : cloths) {
    const Lattice lattice = lattice_of(weave_surface(weave, {400, 400}));
    const LatticeError error = error_of(lattice, weave);
    EXPECT_LT(error.turn_deg, 0.05) << weave.turn_deg << " was found as " << lattice.turn_x_deg;
    EXPECT_LT(error.yarn_px, 0.02) << weave.turn_deg << ": " << lattice.yarn_x_px << " x "
                                   << lattice.yarn_y_px;
  }
}

TEST(Lattice, CountsTheYarnsOfARib) {
  for (const Binding& binding : {kRib22, kRib21, kBasket}) {
    const WeaveSettings weave = {
        .binding = binding, .pitch_x_px = 11, .pitch_y_px = 9, .turn_deg = 1.4, .tone = 0};
    const Lattice lattice = lattice_of(weave_surface(weave, {400, 400}));
    const LatticeError error = error_of(lattice, weave);
    EXPECT_EQ(std::lround(error.yarns_of_cell), binding.crossings()) << binding.name;
    EXPECT_LT(error.yarn_px, 0.02) << binding.name << ": " << lattice.yarn_x_px << " x " << lattice.yarn_y_px;
    EXPECT_LT(error.turn_deg, 0.05) << binding.name << ": " << lattice.turn_x_deg;
  }
}

TEST(Lattice, LiesAsSomebodySaysAndIsRefusedWhereNothingDoes) {
  const Surface cloth = weave_surface({.pitch_x_px = 12, .pitch_y_px = 12, .turn_deg = 25}, {400, 400});
  const double diagonal_px = 12 * std::sqrt(2.0);
  const Lattice yarns = lattice_of(cloth, {.said = {.turn_deg = 24, .x_px = 12, .y_px = 12}}),
                diagonals = lattice_of(cloth, {.said = {.turn_deg = -19}}),
                by_width = lattice_of(cloth, {.said = {.x_px = diagonal_px, .y_px = diagonal_px}});
  EXPECT_NEAR(yarns.turn_x_deg, 25, 0.05);
  EXPECT_NEAR(yarns.yarn_x_px, 12, 0.02);
  EXPECT_NEAR(diagonals.turn_x_deg, -20, 0.05);
  EXPECT_NEAR(by_width.turn_x_deg, -20, 0.05);
  EXPECT_NEAR(by_width.yarn_y_px, diagonal_px, 0.02);
  const Result<Lattice> refused = find_lattice(cloth, {.said = {.turn_deg = 7, .x_px = 12}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(refused.error().why, testing::HasSubstr("turned so and so far apart"));
}

TEST(Lattice, SeesColoursApartFromTheWeave) {
  WeaveSettings weave = {.pitch_x_px = 8.3,
                         .pitch_y_px = 9.1,
                         .turn_deg = 1,
                         .wander = 0.03,
                         .stripe_yarns = 3,
                         .stripe_other = 5};
  const Lattice lattice = lattice_of(weave_surface(weave, {640, 640}));
  const LatticeError error = error_of(lattice, weave);
  EXPECT_TRUE(lattice.colours_repeat);
  EXPECT_NEAR(error.yarns_of_cell, 2, 0.01);
  EXPECT_NEAR(error.yarns_of_colour_cell, 16, 0.05);
  EXPECT_NEAR(length(lattice.axes.a), 8 * 8.3, 0.1);
  EXPECT_NEAR(length(lattice.axes.b), 2 * 9.1, 0.05);
  EXPECT_LT(error.px_a_yarn, 0.02);
}

TEST(Lattice, OfAClothTurnedByHalfARightAngleIsAsGood) {
  const WeaveSettings weave = {
      .binding = kSatin5, .pitch_x_px = 10.3, .pitch_y_px = 11.9, .turn_deg = 45, .wander = 0.03};
  const Lattice lattice = lattice_of(weave_surface(weave, {640, 640}));
  const LatticeError error = error_of(lattice, weave);
  EXPECT_NEAR(error.yarns_of_cell, 5, 0.02);
  EXPECT_LT(error.px_a_yarn, 0.02);
  EXPECT_LT(error.turn_deg, 0.05);
}

TEST(Lattice, OfFeltIsNone) {
  for (const double feature_px : {1.0, 4.0, 12.0}) {
    const Lattice lattice = lattice_of(felt({512, 512}, feature_px));
    EXPECT_EQ(lattice.kind, LatticeKind::kNone) << feature_px << " px: " << lattice.strength;
  }
}

TEST(Lattice, OfCorduroyIsOneWay) {
  for (const double turn_deg : {0.0, 3.7, -31.0}) {
    const Lattice lattice = lattice_of(corduroy({512, 512}, 23.4, turn_deg));
    ASSERT_EQ(lattice.kind, LatticeKind::kOneWay) << turn_deg << ": " << name_of(lattice.kind);
    EXPECT_NEAR(length(lattice.weave.a), 23.4, 0.05) << turn_deg;
    EXPECT_NEAR(degrees(std::atan2(lattice.weave.a.y, lattice.weave.a.x)), turn_deg, 0.3);
    EXPECT_EQ(length(lattice.weave.b), 0);
  }
}

TEST(Lattice, NeedsThreeRepeatsInTheFrame) {
  const WeaveSettings weave = {.pitch_x_px = 40, .pitch_y_px = 40, .wander = 0.02};
  for (const int side : {150, 165}) {
    const Lattice lattice = lattice_of(weave_surface(weave, {side, side}));
    EXPECT_EQ(lattice.kind, LatticeKind::kFewRepeats) << side << ": " << name_of(lattice.kind);
  }
}

TEST(Lattice, OfYarnsUnderFourPixelsIsNamedTooFine) {
  const WeaveSettings weave = {.pitch_x_px = 3.6, .pitch_y_px = 3.7, .turn_deg = 1, .wander = 0.02};
  const Surface cloth = weave_surface(weave, {320, 320});
  EXPECT_EQ(lattice_of(cloth, {.said = {.turn_deg = 1}}).kind, LatticeKind::kTooFine) << "whatever is said";
  const Lattice lattice = lattice_of(cloth);
  EXPECT_EQ(lattice.kind, LatticeKind::kTooFine)
      << name_of(lattice.kind) << ", ways of " << lattice.weave.a.x << ", " << lattice.weave.a.y << " and "
      << lattice.weave.b.x << ", " << lattice.weave.b.y << ", t " << lattice.sublattice_t;
}

TEST(Lattice, IsTheSameForAnyNumberOfThreads) {
  const Surface surface = weave_surface({.binding = kTwill, .wander = 0.04}, {320, 256});
  const Lattice one = lattice_of(surface, {.threads = 1});
  for (const int threads : {2, 3, 7}) {
    const Lattice many = lattice_of(surface, {.threads = threads});
    EXPECT_EQ(one.weave.a, many.weave.a);
    EXPECT_EQ(one.weave.b, many.weave.b);
    EXPECT_EQ(one.residual_px, many.residual_px);
  }
}

TEST(Lattice, OverlooksPixelsWithoutASolution) {
  const WeaveSettings weave = {.binding = kTwill, .turn_deg = 1.5, .wander = 0.03};
  Surface surface = weave_surface(weave, {512, 512});
  for (int y = 200; y < 300; ++y) {
    for (int x = 150; x < 330; ++x) {
      surface.status(x, y) = kNoSolution;
      surface.slope(x, y, 0) = surface.slope(x, y, 1) = 0;
      for (int p = 0; p < 3; ++p) surface.albedo(x, y, p) = 0;
    }
  }
  const LatticeError error = error_of(lattice_of(surface), weave);
  EXPECT_NEAR(error.yarns_of_cell, 4, 0.02);
  EXPECT_LT(error.px_a_yarn, 0.02);
}

TEST(Lattice, IsRefusedOfMapsThatAreNone) {
  EXPECT_FALSE(find_lattice(Surface()));
  EXPECT_FALSE(find_lattice(weave_surface({}, {63, 300})));
  Surface broken = weave_surface({}, {128, 128});
  broken.slope(7, 9, 1) = std::numeric_limits<float>::quiet_NaN();
  const Result<Lattice> refused = find_lattice(broken);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(refused.error().why, testing::HasSubstr("column 7, row 9"));
}

TEST(Lattice, OfALevelClothIsNone) {
  Surface level = weave_surface({.noise_deg = 0}, {128, 128});
  for (int p = 0; p < 2; ++p) {
    for (int y = 0; y < 128; ++y) std::fill_n(level.slope.plane(p).row(y), 128, 0.0F);
  }
  EXPECT_EQ(lattice_of(level).kind, LatticeKind::kNone);
}

}  // namespace
}  // namespace weft::material
