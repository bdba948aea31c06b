// SPDX-License-Identifier: Apache-2.0
#include "simulator/geometry/scene_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "simulator/sampling/random.h"

namespace weft::simulator {
namespace {

constexpr Area kTable = {-30, -20, 30, 20};

struct Named {
  std::string name;
  GeometrySettings settings;
};

std::shared_ptr<const Image<float>> hills() {
  auto heights = std::make_shared<Image<float>>(Size{7, 5});
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 7; ++x) {
      const auto bits = philox({static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, 0}, {3, 0});
      (*heights)(x, y) = static_cast<float>(2 * uniform(bits[0], bits[1]));
    }
  }
  return heights;
}

const std::vector<Named>& surfaces() {
  static const std::vector<Named> all = [] {
    std::vector<Named> list;
    const auto add = [&](const char* name, GeometryKind kind, const auto& change) {
      GeometrySettings g;
      g.kind = kind;
      g.weft_pitch_mm = 0.7;
      change(g);
      list.push_back({name, std::move(g)});
    };
    const auto nothing = [](GeometrySettings&) {};
    add("tilted", GeometryKind::kTilted, nothing);
    add("satin", GeometryKind::kSatin, nothing);
    add("twisted twill", GeometryKind::kTwill, [](auto& g) { g.twist_relief = 0.02; });
    add("flat yarns", GeometryKind::kPlain, [](auto& g) { g.flatness = 0.6, g.crimp = 0.05; });
    add("fibres", GeometryKind::kTwill, [](auto& g) { g.flatness = 0.3, g.fibre_relief = 0.01; });
    add("knit", GeometryKind::kKnit, nothing);
    add("shallow knit", GeometryKind::kKnit,
        [](auto& g) { g.loop_flank_deg = 30, g.course_mm = 1.2, g.yarn_diameter = 0.6; });
    add("sphere", GeometryKind::kSphere, [](auto& g) { g.radius_mm = 15; });
    add("cylinder", GeometryKind::kCylinder, [](auto& g) { g.azimuth_deg = 25, g.contact_deg = 60; });
    add("height map", GeometryKind::kHeightMap, [](auto& g) { g.heights_mm = hills(); });
    add("turned height map", GeometryKind::kHeightMap, [](auto& g) {
      g.heights_mm = hills();
      g.height_map = {4, 2, -3, 30, false};
    });
    add("draped knit", GeometryKind::kKnit, [](auto& g) {
      g.folds = {{2, 20, 30, 4}, {-1, 35, 100, 2}};
      g.waves = {{0.5, 50, 70, 10}};
    });
    return list;
  }();
  return all;
}

template <typename Body>
void for_each_point_of_table(std::uint32_t count, const Body& body) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto bits = philox({i, 0, 0, 0}, {11, 0});
    body(kTable.x1_mm * (2 * uniform(bits[0], bits[1]) - 1),
         kTable.y1_mm * (2 * uniform(bits[2], bits[3]) - 1));
  }
}

TEST(Surface, NormalIsTheCentralDifferenceOfTheHeightButAtCreases) {
  constexpr double kStep_mm = 1e-6;
  for (const Named& each : surfaces()) {
    const Surface s = surface_of(each.settings);
    int creases = 0;
    double worst = 0;
    for_each_point_of_table(2000, [&](double x, double y) {
      const SurfacePoint here = point_at(s, x, y);
      const SurfacePoint east = point_at(s, x + kStep_mm, y), west = point_at(s, x - kStep_mm, y);
      const SurfacePoint north = point_at(s, x, y + kStep_mm), south = point_at(s, x, y - kStep_mm);
      EXPECT_NEAR(length(here.normal), 1, 1e-12) << each.name;
      for (const SurfacePoint& p : {east, west, north, south}) {
        if (length(p.normal - here.normal) > 1e-3) {
          ++creases;
          return;
        }
      }
      const Vec3 difference = normalized({(west.height_mm - east.height_mm) / (2 * kStep_mm),
                                          (south.height_mm - north.height_mm) / (2 * kStep_mm), 1});
      worst = std::max(worst, length(difference - here.normal));
    });
    EXPECT_LT(worst, 2e-6) << each.name;
    EXPECT_LT(creases, 20) << each.name << ": creases are lines";
  }
}

TEST(Surface, StaysWithinItsBounds) {
  for (const Named& each : surfaces()) {
    const Surface s = surface_of(each.settings);
    const HeightRange range = heights_mm(s, kTable);
    double lowest = 1e30, highest = -1e30;
    for_each_point_of_table(100000, [&](double x, double y) {
      const double height = point_at(s, x, y).height_mm;
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
    });
    EXPECT_GE(lowest, range.lowest_mm - 1e-12) << each.name;
    EXPECT_LE(highest, range.highest_mm + 1e-12) << each.name;
    EXPECT_GT(highest - lowest, 0.4 * (range.highest_mm - range.lowest_mm))
        << each.name << ": bounds are loose";
  }
}

TEST(Surface, JumpsNowhereAndIsNoSteeperThanItSays) {
  for (const Named& each : surfaces()) {
    const Surface s = surface_of(each.settings);
    const double steepest = steepest_slope(s);
    double steepest_seen = 0;
    for_each_point_of_table(20000, [&](double x, double y) {
      for (const double step_mm : {1e-5, 1e-3}) {
        const double rise =
            point_at(s, x + 0.6 * step_mm, y + 0.8 * step_mm).height_mm - point_at(s, x, y).height_mm;
        steepest_seen = std::max(steepest_seen, std::abs(rise) / step_mm);
      }
    });
    EXPECT_LE(steepest_seen, steepest * (1 + 1e-6)) << each.name;
    EXPECT_GT(steepest_seen, 0.25 * steepest) << each.name;
  }
}

TEST(Surface, RepeatsAfterItsPeriod) {
  int periodic = 0;
  for (const Named& each : surfaces()) {
    const Surface s = surface_of(each.settings);
    const std::optional<Period> period = period_mm(s);
    if (!period) continue;
    ++periodic;
    for_each_point_of_table(1000, [&](double x, double y) {
      const double here = point_at(s, x, y).height_mm;
      ASSERT_NEAR(point_at(s, x + 2 * period->x_mm, y - period->y_mm).height_mm, here, 1e-9) << each.name;
    });
  }
  EXPECT_EQ(periodic, 7) << "weaves, knits and the level height map that repeats";
}

TEST(Surface, TangentLiesInTheSurfaceAlongTheYarn) {
  for (const Named& each : surfaces()) {
    const Surface s = surface_of(each.settings);
    for_each_point_of_table(500, [&](double x, double y) {
      const SurfacePoint p = point_at(s, x, y);
      const Vec3 tangent = tangent_of(p);
      ASSERT_NEAR(length(tangent), 1, 1e-12) << each.name;
      ASSERT_NEAR(dot(tangent, p.normal), 0, 1e-12) << each.name;
      ASSERT_NEAR(tangent.x * p.along_y, tangent.y * p.along_x, 1e-12) << each.name;
      if (is_woven(each.settings.kind)) {
        ASSERT_EQ(p.yarn.is_weft ? tangent.y : tangent.x, 0) << each.name;
      }
    });
  }
}

TEST(Surface, FoldsAndWavesAddTheirHeightAndSlope) {
  GeometrySettings g;
  g.kind = GeometryKind::kTilted;
  const Surface bare = surface_of(g);
  g.folds = {{3, 40, 90, 4}};
  g.waves = {{0.5, 80, 0, 90}};
  const Surface draped = surface_of(g);
  const auto added = [&](double x, double y) {
    return point_at(draped, x, y).height_mm - point_at(bare, x, y).height_mm;
  };
  EXPECT_NEAR(added(0, 0), 3 + 0.5, 1e-12) << "crest on crest";
  EXPECT_NEAR(added(0, 20), 3 * std::exp(-8.0) + 0.5, 1e-12) << "half-way to the next fold";
  EXPECT_NEAR(added(20, 40), 3, 1e-12) << "the next fold, a quarter of a wave on";
  EXPECT_NEAR(added(40, -40), 3 - 0.5, 1e-12);
  const Vec3 n = point_at(draped, 20, 0).normal, n0 = point_at(bare, 20, 0).normal;
  EXPECT_NEAR(-n.x / n.z, -n0.x / n0.z - 0.5 * 2 * kPi / 80, 1e-12) << "slopes add";
}

TEST(Surface, IsDrapedOnlyWhereTheSceneSaysSo) {
  GeometrySettings g;
  g.kind = GeometryKind::kKnit;
  EXPECT_TRUE(std::holds_alternative<Knit>(surface_of(g)));
  g.waves = {Wave()};
  EXPECT_TRUE(std::holds_alternative<Draped>(surface_of(g)));
}

}  // namespace
}  // namespace weft::simulator
