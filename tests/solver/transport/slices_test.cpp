// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/slices.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "solver/transport/marched_shadows.h"
#include "tests/bench/oracles/rays/traced.h"
#include "tests/solver/transport/cloths.h"

namespace weft::solver {
namespace {

/// Each pixel of the cloth sends back of(x, y, k); around it there is nothing.
template <typename Of>
Image<float> sent_around(const TestCloth& cloth, Rect area, int count, const Of& of) {
  Image<float> sent({area.width(), area.height()}, count);
  const Rect picture = cloth.pixels();
  for (int k = 0; k < count; ++k) {
    for (int y = std::max(area.y0, 0); y < std::min(area.y1, picture.y1); ++y) {
      for (int x = std::max(area.x0, 0); x < std::min(area.x1, picture.x1); ++x)
        sent(x - area.x0, y - area.y0, k) = static_cast<float>(of(x, y, k));
    }
  }
  return sent;
}

template <typename Of>
Image<float> gathered_by_slices(const TestCloth& cloth, Rect tile, int count, const SliceSettings& settings,
                                const Of& of) {
  const Rect area = area_of_slices(tile, settings.reach_px);
  Image<float> sent = sent_around(cloth, area, count, of), light({tile.width(), tile.height()}, count);
  std::vector<View<const float>> planes;
  for (const View<float>& plane : planes_of(sent)) planes.emplace_back(plane);
  const auto done = gather_by_slices(cloth.relief(), tile, cloth.normals_of(tile), {area, planes}, settings,
                                     planes_of(light));
  EXPECT_TRUE(done) << (done ? "" : done.error().message());
  return light;
}

TEST(Slices, GatherNothingOnAPlane) {
  for (const double slope : {0.0, 0.7}) {
    const TestCloth plane = cloth_over({60, 60}, [&](int x, int y) {
      return std::pair{slope * x - slope * y, normalized({-slope, -slope, 1})};
    });
    const auto light = gathered_by_slices(plane, plane.pixels(), 1, {}, [](int, int, int) { return 1; });
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 60; ++x) ASSERT_EQ(light(x, y), 0) << x << ", " << y << ", slope " << slope;
    }
  }
}

TEST(Slices, GatherFromTheOtherWallOfAGrooveByItsFormFactor) {
  const TestCloth cloth = groove({40, 512});
  const Rect tile = {20 - kGrooveHalf + 1, 250, 20, 252};
  const auto light = gathered_by_slices(cloth, tile, 3, {.directions = 64, .reach_px = 240},
                                        [](int x, int, int k) { return x < 20 ? 100 : k; });
  for (int x = tile.x0; x < tile.x1 - 1; ++x) {
    const int column = x - tile.x0;
    const double expected = hidden_in_groove((20.0 - x) / kGrooveHalf);
    EXPECT_NEAR(light(column, 0, 1) / expected, 1, 0.03) << "column " << x;
    EXPECT_NEAR(light(column, 0, 2), 2 * light(column, 0, 1), 1e-5);
  }
}

TEST(Slices, AgreeWithManyRaysOnAWeave) {
  const TestCloth cloth = bumpy_cloth({96, 96});
  const Rect tile = {32, 32, 64, 64};
  const auto of = [](int x, int y, int) { return 0.5 + 0.3 * std::sin(0.3 * x + 0.2 * y); };
  const test::HeightGrid grid = test::grid_of(cloth, cloth.pixels(), 0);
  std::vector<float> values;
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) values.push_back(static_cast<float>(of(x, y, 0)));
  }
  const auto truth =
      test::gathered_in(grid, cloth, tile, {cloth.pixels(), 1, values}, {.rays = 2048, .reach_px = 30});
  const auto error_of = [&](const Image<float>& found) {
    double squares = 0;
    for (int y = 0; y < tile.height(); ++y) {
      for (int x = 0; x < tile.width(); ++x)
        squares += std::pow(static_cast<double>(found(x, y)) - static_cast<double>(truth(x, y)), 2);
    }
    return std::sqrt(squares / static_cast<double>(tile.pixels()));
  };
  const double by_rays = error_of(
      test::gathered_in(grid, cloth, tile, {cloth.pixels(), 1, values}, {.rays = 32, .reach_px = 30}));
  const double by_slices = error_of(gathered_by_slices(cloth, tile, 1, {.reach_px = 30}, of));
  EXPECT_LT(by_slices, 0.012);
  EXPECT_LT(by_slices, by_rays) << "of 32 rays";
  const SliceSettings coarse = {.directions = 6, .steps = 8, .reach_px = 30};
  const double by_few = error_of(gathered_by_slices(cloth, tile, 1, coarse, of));
  EXPECT_GT(by_few, by_slices);
  EXPECT_LT(by_few, 0.015);
}

TEST(Slices, OfAMosaicGatherFromPhotositesOfOneColour) {
  const TestCloth cloth = bumpy_cloth({47, 33});
  const auto phase = [](int x, int y, int) { return 1 + x % 2 + 2 * (y % 2); };
  const SliceSettings mosaic = {.reach_px = 10, .mosaic = true};
  const Rect tile = {12, 12, 35, 21};  // all in reach is in the picture
  const auto light = gathered_by_slices(cloth, tile, 1, mosaic, phase);
  const auto of_ones = gathered_by_slices(cloth, tile, 1, mosaic, [](int, int, int) { return 1; });
  for (int y = 0; y < tile.height(); ++y) {
    for (int x = 0; x < tile.width(); ++x) {
      const float expected = static_cast<float>(phase(x + tile.x0, y + tile.y0, 0)) * of_ones(x, y);
      EXPECT_NEAR(light(x, y), expected, 1e-5) << x << ", " << y;
    }
  }
}

TEST(Slices, AreTheSameBytesFromTilesAndThreads) {
  const TestCloth cloth = bumpy_cloth({150, 70});
  const SliceSettings settings = {.reach_px = 24, .mosaic = true};
  const auto of = [](int x, int y, int k) { return 0.1 + ((7 * x + 13 * y + k) % 29) / 30.0; };
  const auto expected = gathered_by_slices(cloth, cloth.pixels(), 4, settings, of);
  const std::vector<Rect> tiles = {{0, 0, 64, 35},    {64, 0, 150, 35}, {0, 35, 91, 70},
                                   {91, 35, 150, 70}, {37, 11, 54, 13}, {149, 69, 150, 70}};
  for (const int threads : {1, 4}) {
    parallel_for(tiles.size(), threads, [&](std::size_t i, int) {
      const Rect tile = tiles[i];
      const auto light = gathered_by_slices(cloth, tile, 4, settings, of);
      for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
          for (int k = 0; k < 4; ++k)
            ASSERT_EQ(light(x - tile.x0, y - tile.y0, k), expected(x, y, k)) << x << ", " << y << ", " << k;
        }
      }
    });
  }
}

TEST(Slices, RefuseWhatDoesNotFit) {
  const TestCloth cloth = bumpy_cloth({60, 20});
  const Rect tile = {0, 0, 20, 20}, area = area_of_slices(tile, 10);
  Image<float> sent({area.width(), area.height()}), light({20, 20});
  const auto why = [&](Rect of, const SliceSettings& settings) {
    const std::vector<View<const float>> planes = {sent.plane()};
    const auto done = gather_by_slices(cloth.relief(), tile, cloth.normals_of(tile), {of, planes}, settings,
                                       planes_of(light));
    return done ? std::string("done") : done.error().remedy;
  };
  EXPECT_EQ(why(area, {.reach_px = 10}), "done");
  EXPECT_EQ(why(area, {.directions = 3, .reach_px = 10}),
            "ask for from 4 to 64 directions and steps and at least 1 pixel");
  EXPECT_EQ(why(tile, {.reach_px = 10}), "give what columns -11 to 31 and rows -11 to 31 send back");
  std::fill_n(sent.plane().row(11), area.width(), std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(why(area, {.reach_px = 10}), "replace readings that cannot be used");
}

Image<std::uint32_t> marched_in(const TestCloth& cloth, Rect tile, const LightDirections& lights,
                                int reach_px) {
  Image<std::uint32_t> bits({tile.width(), tile.height()}, visibility_words(lights.count));
  const auto done =
      march_to_lights(cloth.relief(), tile, cloth.normals_of(tile), lights, reach_px, planes_of(bits));
  EXPECT_TRUE(done) << (done ? "" : done.error().message());
  return bits;
}

TEST(MarchedShadows, AreThoseOfRaysButForTheirEdges) {
  const TestCloth cloth = bumpy_cloth({96, 96});
  const auto by_rays =
      test::visible_in(test::grid_of(cloth, cloth.pixels(), 0), cloth, cloth.pixels(), near_lights(), 40);
  const auto marched = marched_in(cloth, cloth.pixels(), near_lights(), 40);
  int hidden = 0, differing = 0;
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) {
      hidden += 10 - std::popcount(by_rays(x, y));
      differing += std::popcount(by_rays(x, y) ^ marched(x, y));
    }
  }
  EXPECT_GT(hidden, 10000);
  EXPECT_LT(differing, hidden / 50) << "of " << hidden;
}

TEST(MarchedShadows, EndWhereAStepPutsThem) {
  constexpr double kHeight_px = 6;
  const TestCloth step = cloth_over({80, 8}, [&](int x, int) {
    return std::pair{x < 20 ? kHeight_px : 0.0, Vec3{0, 0, 1}};
  });
  for (const double elevation_deg : {15.0, 28.0, 55.0}) {
    const auto bits = marched_in(step, step.pixels(), distant({direction_of(elevation_deg, 180)}), 60);
    const double end = 19 + kHeight_px / std::tan(radians(elevation_deg));
    for (int x = 0; x < 80; ++x) {
      if (std::abs(x - end) < 1) continue;
      EXPECT_EQ(bits(x, 4) == 0, x >= 20 && x < end) << "column " << x << " of " << elevation_deg;
    }
  }
}

TEST(MarchedShadows, AreTheSameBytesFromTilesOfAnySize) {
  const TestCloth cloth = bumpy_cloth({150, 70});
  const auto whole = marched_in(cloth, cloth.pixels(), near_lights(), 24);
  for (const Rect tile : {Rect{0, 0, 64, 35}, Rect{37, 11, 54, 13}, Rect{149, 69, 150, 70}}) {
    const auto part = marched_in(cloth, tile, near_lights(), 24);
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x)
        ASSERT_EQ(part(x - tile.x0, y - tile.y0), whole(x, y)) << x << ", " << y;
    }
  }
}

}  // namespace
}  // namespace weft::solver
