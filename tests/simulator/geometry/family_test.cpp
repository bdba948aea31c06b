// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "tests/simulator/geometry/relief_statistics.h"

namespace weft::simulator {
namespace {

/// Directions to the ten default LEDs from the table's centre.
std::vector<Vec3> led_directions() {
  std::vector<Vec3> directions;
  const auto ring = [&](int count, double zenith_deg, double azimuth_deg) {
    for (int i = 0; i < count; ++i) {
      const double zenith = radians(zenith_deg), azimuth = radians(azimuth_deg + 360.0 * i / count);
      directions.push_back(
          {std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)});
    }
  };
  ring(4, 35, 0);
  ring(6, 62, 15);
  return directions;
}

ReliefStatistics statistics_of(const GeometrySettings& settings) {
  constexpr int kSamplesPerPeriod = 48;  // 160 gives the same within a third of each bar
  return ReliefGrid(surface_of(settings), kSamplesPerPeriod).statistics(led_directions());
}

TEST(ReliefGrid, HasTheClosedFormsOfALevelAndAGroovedSurface) {
  // The walls of a 90-degree groove are open to its mouth only: cos(45 degrees) of their area.
  auto roof = std::make_shared<Image<float>>(Size{64, 64});
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) (*roof)(x, y) = static_cast<float>(std::abs(x - 32));
  }
  GeometrySettings g;
  g.kind = GeometryKind::kHeightMap;
  g.height_map.mm_per_sample = 1;
  g.heights_mm = std::make_shared<Image<float>>(Size{4, 4});
  const ReliefStatistics level = ReliefGrid(surface_of(g), 8).statistics(led_directions());
  EXPECT_EQ(level.mean_slope_deg, 0);
  EXPECT_EQ(level.shadowed, 0);
  EXPECT_NEAR(level.closed, 0, 1e-12);
  g.heights_mm = roof;
  const ReliefStatistics grooved = ReliefGrid(surface_of(g), 64).statistics({normalized({1, 0, 0.5})});
  EXPECT_NEAR(grooved.mean_slope_deg, 45, 2);
  EXPECT_NEAR(grooved.closed, 1 - std::sqrt(0.5), 0.02);
  EXPECT_NEAR(grooved.shadowed, 0.5 + 1.0 / 6, 0.03)
      << "half turned away, a third of the rest behind the ridge";
}

TEST(Family, SmoothHasItsSlopeShadowsAndOpenness) {
  const ReliefStatistics s = statistics_of(family_settings(Family::kSmooth));
  EXPECT_NEAR(s.mean_slope_deg, 7, 0.5);
  EXPECT_EQ(s.shadowed, 0);
  EXPECT_NEAR(s.closed, 0.009, 0.0009);
}

TEST(Family, PlainHasItsSlopeShadowsAndOpenness) {
  const ReliefStatistics s = statistics_of(family_settings(Family::kPlain));
  EXPECT_NEAR(s.mean_slope_deg, 19, 1);
  EXPECT_LE(s.shadowed, 0.01);
  EXPECT_NEAR(s.closed, 0.063, 0.0063);
}

TEST(Family, DeepHasItsSlopeShadowsAndOpenness) {
  const ReliefStatistics s = statistics_of(family_settings(Family::kDeep));
  EXPECT_NEAR(s.mean_slope_deg, 36, 1);
  EXPECT_NEAR(s.shadowed, 0.19, 0.01);
  EXPECT_NEAR(s.closed, 0.206, 0.0206);
}

TEST(Family, YarnsStayBesideTheirNeighbours) {
  for (const Family family : {Family::kSmooth, Family::kPlain, Family::kDeep})
    EXPECT_TRUE(yarns_stay_beside_their_neighbours(family_settings(family)));
}

}  // namespace
}  // namespace weft::simulator
