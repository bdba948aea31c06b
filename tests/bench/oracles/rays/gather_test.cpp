// SPDX-License-Identifier: Apache-2.0
#include "bench/oracles/rays/gather.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "tests/bench/oracles/rays/traced.h"

namespace weft::test {
namespace {

using namespace solver;

/// Each pixel sends back of(x, y, k).
template <typename Of>
std::vector<float> radiosity_over(Rect area, int count, const Of& of) {
  std::vector<float> values;
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      for (int k = 0; k < count; ++k) values.push_back(static_cast<float>(of(x, y, k)));
    }
  }
  return values;
}

TEST(GatheredLight, IsNothingOnAPlane) {
  for (const double slope : {0.0, 0.7}) {
    const TestCloth plane = cloth_over({60, 60}, [&](int x, int y) {
      return std::pair{slope * x - slope * y, normalized({-slope, -slope, 1})};
    });
    const HeightGrid grid = grid_of(plane, plane.pixels(), 0);
    const auto values = radiosity_over(plane.pixels(), 2, [](int, int, int) { return 1; });
    const auto light = gathered_in(grid, plane, plane.pixels(), {plane.pixels(), 2, values}, {});
    const auto openness = openness_in(grid, plane, plane.pixels(), {});
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 60; ++x) {
        ASSERT_EQ(light(x, y, 0), 0) << x << ", " << y << ", slope " << slope;
        ASSERT_EQ(light(x, y, 1), 0);
        ASSERT_EQ(openness(x, y), 1);
      }
    }
  }
}

TEST(GatheredLight, ComesFromTheOtherWallOfAGrooveByItsFormFactor) {
  const TestCloth cloth = groove({40, 512});
  const HeightGrid grid = grid_of(cloth, cloth.pixels(), 0);
  const Rect tile = {20 - kGrooveHalf + 1, 250, 20, 258};
  const auto values = radiosity_over(cloth.pixels(), 3, [](int x, int, int k) { return x < 20 ? 100 : k; });
  const auto light =
      gathered_in(grid, cloth, tile, {cloth.pixels(), 3, values}, {.rays = 512, .reach_px = 250});
  for (int x = tile.x0; x < tile.x1 - 1; ++x) {
    double mean = 0;
    for (int y = 0; y < tile.height(); ++y) {
      EXPECT_EQ(light(x - tile.x0, y, 0), 0) << "the other wall is dark";
      EXPECT_NEAR(light(x - tile.x0, y, 2), 2 * light(x - tile.x0, y, 1), 1e-5);
      mean += static_cast<double>(light(x - tile.x0, y, 1)) / tile.height();
    }
    EXPECT_NEAR(mean / hidden_in_groove((20.0 - x) / kGrooveHalf), 1, 0.02) << "column " << x;
  }
}

// Any two points of a sphere see each other alike: where the light on the inside of a cap is E everywhere,
// all bounces together make x = rho E / (1 - rho F) with F = (1 - cos theta) / 2.
TEST(GatheredLight, OfARoundBowlSettlesAtItsGeometricSeries) {
  constexpr double kTheta = 60 * kPi / 180, kRadius = 24, kAlbedo = 0.8, kDirect = 0.6;
  constexpr int kCentre = 24;
  const TestCloth bowl = cloth_over({49, 49}, [&](int x, int y) {
    const double from_centre = std::hypot(x - kCentre, y - kCentre), rim = kRadius * std::sin(kTheta);
    const double depth =
        std::sqrt(kRadius * kRadius - std::min(from_centre, rim) * std::min(from_centre, rim));
    return std::pair{-depth, normalized({-1.0 * (x - kCentre), 1.0 * (y - kCentre), depth})};
  });
  const HeightGrid grid = grid_of(bowl, bowl.pixels(), 0);
  const double share = (1 - std::cos(kTheta)) / 2, expected = kAlbedo * kDirect / (1 - kAlbedo * share);
  std::vector<float> values(49 * 49, static_cast<float>(kAlbedo * kDirect));
  for (int round = 0; round < 7; ++round) {
    const auto light = gathered_in(grid, bowl, bowl.pixels(), {bowl.pixels(), 1, values}, {.rays = 64});
    values = radiosity_over(bowl.pixels(), 1, [&](int x, int y, int) {
      return kAlbedo * (kDirect + static_cast<double>(light(x, y)));
    });
  }
  double mean = 0;
  int pixels = 0;
  for (int y = 0; y < 49; ++y) {
    for (int x = 0; x < 49; ++x) {
      if (std::hypot(x - kCentre, y - kCentre) > 18) continue;
      const double found = static_cast<double>(values[static_cast<std::size_t>(y * 49 + x)]);
      EXPECT_NEAR(found / expected, 1, 0.06) << x << ", " << y;
      mean += found;
      ++pixels;
    }
  }
  EXPECT_NEAR(mean / pixels / expected, 1, 0.01);
}

TEST(GatheredLight, OfAMosaicComesFromPhotositesOfOneColour) {
  const TestCloth cloth = bumpy_cloth({47, 33});
  const HeightGrid grid = grid_of(cloth, cloth.pixels(), 0);
  const auto phase = [](int x, int y) { return 1 + x % 2 + 2 * (y % 2); };
  const auto values = radiosity_over(cloth.pixels(), 1, [&](int x, int y, int) { return phase(x, y); });
  const Radiosity radiosity = {cloth.pixels(), 1, values};
  const auto snapped = gathered_in(grid, cloth, cloth.pixels(), radiosity, {.mosaic = true});
  const auto mixed = gathered_in(grid, cloth, cloth.pixels(), radiosity, {});
  const auto openness = openness_in(grid, cloth, cloth.pixels(), {});
  int differing = 0;
  for (int y = 0; y < 33; ++y) {
    for (int x = 0; x < 47; ++x) {
      const float of_one_colour = static_cast<float>(phase(x, y)) * (1 - openness(x, y));
      EXPECT_NEAR(snapped(x, y), of_one_colour, 1e-5) << x << ", " << y;
      differing += std::abs(mixed(x, y) - of_one_colour) > 0.01F;
    }
  }
  EXPECT_GT(differing, 500) << "without snapping colours mix";
}

TEST(GatheredLight, IsTheSameBytesFromBlocksTilesAndThreads) {
  const TestCloth cloth = bumpy_cloth({150, 70});
  const GatherSettings settings = {.rays = 12, .reach_px = 24, .mosaic = true};
  const auto of = [](int x, int y, int k) { return 0.1 + ((7 * x + 13 * y + k) % 29) / 30.0; };
  const auto values = radiosity_over(cloth.pixels(), 4, of);
  const auto expected = gathered_in(grid_of(cloth, cloth.pixels(), 0), cloth, cloth.pixels(),
                                    {cloth.pixels(), 4, values}, settings);
  const std::vector<Rect> tiles = {{0, 0, 64, 35},    {64, 0, 150, 35}, {0, 35, 91, 70},
                                   {91, 35, 150, 70}, {37, 11, 54, 13}, {149, 69, 150, 70}};
  for (const int threads : {1, 4}) {
    parallel_for(tiles.size(), threads, [&](std::size_t i, int) {
      const Rect tile = tiles[i];
      const HeightGrid grid = grid_of(cloth, tile, 25);
      const auto some = radiosity_over(grid.area(), 4, of);
      const auto light = gathered_in(grid, cloth, tile, {grid.area(), 4, some}, settings);
      for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
          for (int k = 0; k < 4; ++k) {
            ASSERT_EQ(light(x - tile.x0, y - tile.y0, k), expected(x, y, k)) << x << ", " << y << ", " << k;
          }
        }
      }
    });
  }
}

TEST(GatheredLight, HasTheStatedErrorAtTheDefaultNumberOfRays) {
  const TestCloth cloth = bumpy_cloth({64, 64});
  const HeightGrid grid = grid_of(cloth, cloth.pixels(), 0);
  const Rect tile = {24, 24, 40, 40};
  const auto truth = openness_in(grid, cloth, tile, {.rays = 1024});
  const auto found = openness_in(grid, cloth, tile, {});
  double squares = 0, mean = 0;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const double error = static_cast<double>(found(x, y)) - static_cast<double>(truth(x, y));
      squares += error * error / 256;
      mean += error / 256;
    }
  }
  EXPECT_LT(std::sqrt(squares), 0.03);
  EXPECT_NEAR(mean, 0, 0.004);
}

TEST(GatheredLight, LeavesNormalsThatAreNoneLookingUp) {
  TestCloth cloth = bumpy_cloth({40, 40});
  const HeightGrid grid = grid_of(cloth, cloth.pixels(), 0);
  const auto normal_at = [&](int x, Vec3 n) {
    for (const auto& [plane, v] : {std::pair{0, n.x}, {1, n.y}, {2, n.z}}) {
      cloth.normal(x, 20, plane) = static_cast<float>(v);
    }
  };
  const Rect pixel = {17, 20, 18, 21};
  normal_at(17, {0, 0, 1});
  const float expected = openness_in(grid, cloth, pixel, {})(0, 0);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec3 n : {Vec3{kNan, 0, 1}, Vec3{0, 0, 0}, Vec3{0.1, 0, -1}, Vec3{0, 0, kNan},
                       Vec3{std::numeric_limits<double>::infinity(), 0, 1}, Vec3{0, 0, 7}}) {
    normal_at(17, n);
    EXPECT_EQ(openness_in(grid, cloth, pixel, {})(0, 0), expected) << n.x << ", " << n.z;
  }
}

TEST(GatheredLight, RefusesWhatDoesNotFit) {
  const TestCloth cloth = bumpy_cloth({60, 20});
  const Rect block = {0, 0, 20, 20};
  const HeightGrid grid = grid_of(cloth, block, 11);
  std::vector<float> values(31 * 20, 0.5F);
  Image<float> light({20, 20});
  const auto why = [&](const Radiosity& radiosity, const GatherSettings& settings, std::size_t planes) {
    const auto views = planes_of(light);
    const auto done = gather_light(grid, block, cloth.normals_of(block), radiosity, settings,
                                   std::span(views).first(planes));
    if (done) return std::string("done");
    EXPECT_EQ(done.error().kind, ErrorKind::kBadData);
    return done.error().remedy;
  };
  const Radiosity whole = {grid.area(), 1, values};
  EXPECT_EQ(why(whole, {.reach_px = 10}, 1), "done");
  EXPECT_EQ(why(whole, {.reach_px = 11}, 1), "build the block with a halo of 12 pixels");
  EXPECT_EQ(why(whole, {.rays = 0, .reach_px = 10}, 1), "ask for from 1 to 4096");
  EXPECT_EQ(why(whole, {.reach_px = 10}, 0), "give 1 planes of the tile's size");
  const std::string needs_all = "give what columns 0 to 31 and rows 0 to 20 send back";
  EXPECT_EQ(why({{0, 0, 30, 20}, 1, values}, {.reach_px = 10}, 1), needs_all);
  EXPECT_EQ(why({grid.area(), 2, values}, {.reach_px = 10}, 1), needs_all);
  EXPECT_EQ(why({grid.area(), 0, {}}, {.reach_px = 10}, 0), needs_all);
  std::ranges::fill(values, std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(why(whole, {.reach_px = 10}, 1), "replace readings that cannot be used");
}

}  // namespace
}  // namespace weft::test
