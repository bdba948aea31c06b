// SPDX-License-Identifier: Apache-2.0
#include "simulator/geometry/weave.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "simulator/geometry/scene_surface.h"
#include "simulator/sampling/random.h"

namespace weft::simulator {
namespace {

GeometrySettings woven(GeometryKind kind, double twist_relief = 0) {
  GeometrySettings g;
  g.kind = kind;
  g.warp_pitch_mm = 0.5;
  g.weft_pitch_mm = 0.7;
  g.twist_relief = twist_relief;
  return g;
}

const std::vector<GeometrySettings>& cloths() {
  static const std::vector<GeometrySettings> all = {woven(GeometryKind::kPlain), woven(GeometryKind::kTwill),
                                                    woven(GeometryKind::kSatin),
                                                    woven(GeometryKind::kTwill, 0.02)};
  return all;
}

/// Points all over a few periods, on both sides of the origin.
template <typename Body>
void for_each_point_of_periods(std::uint32_t count, const Body& body) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto bits = philox({i, 0, 0, 0}, {7, 0});
    body(20 * uniform(bits[0], bits[1]) - 10, 20 * uniform(bits[2], bits[3]) - 10);
  }
}

bool same_yarn(Yarn a, Yarn b) {
  return a.is_weft == b.is_weft && a.index == b.index;
}

double mean_slope_deg(const Weave& weave) {
  constexpr int kSteps = 400;
  double sum = 0;
  for (int j = 0; j < kSteps; ++j) {
    for (int i = 0; i < kSteps; ++i) {
      sum += angle_deg(
          {0, 0, 1},
          weave.at((i + 0.5) / kSteps * weave.period_x_mm(), (j + 0.5) / kSteps * weave.period_y_mm())
              .normal);
    }
  }
  return sum / (kSteps * kSteps);
}

TEST(Plane, LeansTowardsItsAzimuth) {
  GeometrySettings g;
  g.kind = GeometryKind::kTilted;
  g.tilt_deg = 20;
  g.azimuth_deg = 90;
  const TablePlane plane = std::get<TablePlane>(surface_of(g));
  const SurfacePoint p = plane.at(5, 10);
  EXPECT_NEAR(p.normal.x, 0, 1e-15);
  EXPECT_NEAR(p.normal.y, std::sin(radians(20)), 1e-15);
  EXPECT_NEAR(p.normal.z, std::cos(radians(20)), 1e-15);
  EXPECT_NEAR(p.height_mm, -10 * std::tan(radians(20)), 1e-12) << "a normal towards y means falling with y";
  EXPECT_EQ(plane.at(0, 0).height_mm, 0);
}

TEST(Plane, IsLevelForAFlatCloth) {
  const SurfacePoint p = std::get<TablePlane>(surface_of(GeometrySettings())).at(31, -7);
  EXPECT_EQ(p.normal, (Vec3{0, 0, 1}));
  EXPECT_EQ(p.height_mm, 0);
}

TEST(Weave, NormalIsTheCentralDifferenceOfTheHeight) {
  constexpr double kStep_mm = 1e-6;
  for (const GeometrySettings& g : cloths()) {
    const Weave weave(g);
    int compared = 0;
    double worst = 0;
    for_each_point_of_periods(2000, [&](double x, double y) {
      const SurfacePoint here = weave.at(x, y);
      const SurfacePoint east = weave.at(x + kStep_mm, y), west = weave.at(x - kStep_mm, y);
      const SurfacePoint north = weave.at(x, y + kStep_mm), south = weave.at(x, y - kStep_mm);
      for (const SurfacePoint& p : {east, west, north, south}) {
        if (!same_yarn(p.yarn, here.yarn)) return;  // a crease has no normal
      }
      const Vec3 difference = normalized({(west.height_mm - east.height_mm) / (2 * kStep_mm),
                                          (south.height_mm - north.height_mm) / (2 * kStep_mm), 1});
      worst = std::max(worst, length(difference - here.normal));
      ++compared;
    });
    EXPECT_LT(worst, 1e-6) << "kind " << static_cast<int>(g.kind);
    EXPECT_GT(compared, 1980) << "creases are lines";
  }
}

TEST(Weave, RepeatsAfterItsPeriod) {
  for (const GeometrySettings& g : cloths()) {
    const Weave weave(g);
    for_each_point_of_periods(500, [&](double x, double y) {
      const SurfacePoint a = weave.at(x, y);
      const SurfacePoint b = weave.at(x + 3 * weave.period_x_mm(), y - 2 * weave.period_y_mm());
      ASSERT_NEAR(a.height_mm, b.height_mm, 1e-12) << x << ", " << y;
      if (same_yarn({a.yarn.is_weft, 0}, {b.yarn.is_weft, 0})) {
        ASSERT_LT(length(a.normal - b.normal), 1e-9) << x << ", " << y;
      }
    });
  }
}

TEST(Weave, HasCreasesButNoJumps) {
  constexpr double kStep_mm = 1e-3;
  for (const GeometrySettings& g : cloths()) {
    const Weave weave(g);
    double steepest = 0;
    for (int line = 0; line < 40; ++line) {
      const double across_mm = line * 0.0731;
      double east = weave.at(0, across_mm).height_mm, north = weave.at(across_mm, 0).height_mm;
      for (int i = 1; i < 4000; ++i) {
        const double x_height = weave.at(i * kStep_mm, across_mm).height_mm;
        const double y_height = weave.at(across_mm, i * kStep_mm).height_mm;
        steepest = std::max({steepest, std::abs(x_height - east), std::abs(y_height - north)});
        east = x_height;
        north = y_height;
      }
    }
    EXPECT_LT(steepest, 1.5 * kStep_mm) << "kind " << static_cast<int>(g.kind);
    EXPECT_GT(steepest, 0.9 * kStep_mm * std::tan(radians(g.flank_deg))) << "flanks were crossed";
  }
}

TEST(Weave, ShowsTheYarnThatTheDraftPutsOnTop) {
  for (const GeometrySettings& g : cloths()) {
    const Weave weave(g);
    const Draft draft = draft_of(g);
    const double crimp_mm = g.crimp * (g.warp_pitch_mm + g.weft_pitch_mm) / 2;
    for (int i = -3; i < 8; ++i) {
      for (int j = -3; j < 8; ++j) {
        const int phase = ((j - draft.step * i) % draft.period() + draft.period()) % draft.period();
        const SurfacePoint p = weave.at((i + 0.5) * g.warp_pitch_mm, (j + 0.5) * g.weft_pitch_mm);
        EXPECT_EQ(p.yarn.is_weft, phase >= draft.over) << i << ", " << j;
        EXPECT_EQ(p.yarn.index, p.yarn.is_weft ? j : i);
        if (g.twist_relief > 0) continue;
        EXPECT_NEAR(p.height_mm, crimp_mm, 1e-12) << "the crest of a yarn on top";
        EXPECT_NEAR(p.normal.z, 1, 1e-12);
      }
    }
  }
}

TEST(Weave, IsLevelAcrossTheFlatPartOfAYarn) {
  GeometrySettings g = woven(GeometryKind::kPlain);
  g.flatness = 0.5;
  g.crimp = 0.05;
  const Weave weave(g);
  const double y = 0.5 * g.weft_pitch_mm, half_mm = 0.25 * g.warp_pitch_mm, crest_mm = 0.05 * 0.6;
  const SurfacePoint middle = weave.at(0.5 * g.warp_pitch_mm, y);
  ASSERT_FALSE(middle.yarn.is_weft);
  for (const double across : {-0.99, -0.5, 0.0, 0.99}) {
    const SurfacePoint p = weave.at(0.5 * g.warp_pitch_mm + across * half_mm, y);
    EXPECT_NEAR(p.height_mm, crest_mm, 1e-12) << across;
    EXPECT_NEAR(p.normal.z, 1, 1e-12) << across;
  }
  const SurfacePoint rim = weave.at(0.5 * g.warp_pitch_mm + 1.9 * half_mm, y);
  EXPECT_LT(rim.height_mm, crest_mm - 0.01) << "round beyond";
}

TEST(Weave, WarpCoversFourFifthsOfASatinsCrossings) {
  const Draft satin = draft_of(woven(GeometryKind::kSatin));
  EXPECT_EQ(satin.over, 4);
  EXPECT_EQ(satin.period(), 5);
  EXPECT_EQ(satin.step, 2) << "neighbouring crossings of a satin do not touch";
}

TEST(Weave, SlopesLikeClothByDefault) {
  for (const GeometryKind kind : {GeometryKind::kPlain, GeometryKind::kTwill, GeometryKind::kSatin}) {
    GeometrySettings g;
    g.kind = kind;
    const double slope_deg = mean_slope_deg(Weave(g));
    EXPECT_GT(slope_deg, 15) << static_cast<int>(kind);
    EXPECT_LT(slope_deg, 20) << static_cast<int>(kind);
    g.warp_pitch_mm = g.weft_pitch_mm = 4;
    EXPECT_NEAR(mean_slope_deg(Weave(g)), slope_deg, 1e-6) << "the same at any scale";
  }
}

TEST(Weave, SlopesMoreWithSteeperFlanks) {
  double last_deg = 0;
  for (const double flank_deg : {15.0, 30.0, 45.0, 60.0}) {
    GeometrySettings g = woven(GeometryKind::kPlain);
    g.flank_deg = flank_deg;
    g.crimp = 0.05;
    const double slope_deg = mean_slope_deg(Weave(g));
    EXPECT_GT(slope_deg, last_deg + 3) << flank_deg;
    last_deg = slope_deg;
  }
}

}  // namespace
}  // namespace weft::simulator
