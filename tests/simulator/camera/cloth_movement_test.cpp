// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/cloth_movement.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::simulator {
namespace {

TEST(ClothMovement, LeavesTheClothWithoutSigma) {
  const ClothMovement still = movement_of_shot({}, 3, {1, 0});
  EXPECT_EQ(still.on_cloth({12.5, -3.25, 0.5}), (Vec3{12.5, -3.25, 0.5}));
  EXPECT_EQ(still.turned({0.6, 0, 0.8}), (Vec3{0.6, 0, 0.8}));
}

TEST(ClothMovement, TurnsAboutTheTableAndThenShifts) {
  const ClothMovement quarter = {0, 1, 10, 20};
  EXPECT_EQ(quarter.turned({1, 0, 0}), (Vec3{0, 1, 0}));
  // The cloth's point (1, 0) turns to (0, 1) and lands at (10, 21).
  EXPECT_EQ(quarter.on_cloth({10, 21, 3}), (Vec3{1, 0, 3}));
}

TEST(ClothMovement, HasTheStandardDeviationsOfItsSettings) {
  constexpr int kShots = 20000;
  double xx = 0, yy = 0, xy = 0, turn = 0;
  for (int shot = 0; shot < kShots; ++shot) {
    const ClothMovement m = movement_of_shot({0.3, 2}, shot, {5, 0});
    const double angle_deg = degrees(std::atan2(m.sine, m.cosine));
    xx += m.x_mm * m.x_mm;
    yy += m.y_mm * m.y_mm;
    xy += m.x_mm * m.y_mm;
    turn += angle_deg * angle_deg;
  }
  const double four_errors = 4 / std::sqrt(2.0 * kShots);
  EXPECT_NEAR(std::sqrt(xx / kShots), 0.3, 0.3 * four_errors);
  EXPECT_NEAR(std::sqrt(yy / kShots), 0.3, 0.3 * four_errors);
  EXPECT_NEAR(std::sqrt(turn / kShots), 2, 2 * four_errors);
  EXPECT_NEAR(xy / kShots, 0, 4 * 0.09 / std::sqrt(double{kShots}));
}

TEST(ClothMovement, DependsOnShotAndSeedAlone) {
  const MovementSettings settings = {1, 1};
  EXPECT_EQ(movement_of_shot(settings, 4, {5, 0}).x_mm, movement_of_shot(settings, 4, {5, 0}).x_mm);
  EXPECT_NE(movement_of_shot(settings, 4, {5, 0}).x_mm, movement_of_shot(settings, 5, {5, 0}).x_mm);
  EXPECT_NE(movement_of_shot(settings, 4, {5, 0}).x_mm, movement_of_shot(settings, 4, {6, 0}).x_mm);
}

}  // namespace
}  // namespace weft::simulator
