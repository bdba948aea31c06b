// SPDX-License-Identifier: Apache-2.0
#include "exchange/presets/reduce.h"

#include <gtest/gtest.h>

#include <cmath>

#include "exchange/presets/mips.h"
#include "tests/exchange/presets/maps.h"

namespace weft::exchange {
namespace {

TEST(Reducing, KeepsTheMeanForSidesThatDoNotDivide) {
  Image<float> fine({7, 5});
  double sum = 0;
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 7; ++x) sum += static_cast<double>(fine(x, y) = static_cast<float>(x * x - 3 * y));
  }
  Image<float> coarse({3, 2});
  reduce(fine.plane(), Averaging::kMean, 1, coarse.plane());
  double coarse_sum = 0;
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 3; ++x) coarse_sum += static_cast<double>(coarse(x, y));
  }
  EXPECT_NEAR(coarse_sum / 6, sum / 35, 1e-6);
}

TEST(Reducing, OfOnePixelToOnePixelIsThatPixel) {
  Image<float> one({1, 1}), other({1, 1});
  one(0, 0) = 0.625F;
  for (const Averaging how : {Averaging::kMean, Averaging::kSquares, Averaging::kNearest}) {
    reduce(one.plane(), how, 1, other.plane());
    EXPECT_EQ(other(0, 0), 0.625F);
  }
}

TEST(Reducing, AveragesNormalsBySlopesAndKeepsThemUnit) {
  TestMaps maps({8, 8});
  maps.set_slopes([](int x, int) { return std::array<double, 2>{x % 2 == 0 ? 0.8 : 0.0, 0.2}; });
  Image<float> coarse({4, 4}, 3);
  const SourcePlanes& planes = maps.planes();
  reduce_normals({planes[3].pixels, planes[4].pixels, planes[5].pixels}, 1,
                 {coarse.plane(0), coarse.plane(1), coarse.plane(2)});
  EXPECT_NEAR(-coarse(1, 1, 0) / coarse(1, 1, 2), 0.4, 1e-5);
  EXPECT_NEAR(-coarse(1, 1, 1) / coarse(1, 1, 2), 0.2, 1e-5);
  EXPECT_NEAR(std::hypot(std::hypot(coarse(1, 1, 0), coarse(1, 1, 1)), coarse(1, 1, 2)), 1, 1e-6);
}

TEST(Reducing, IsTheSameForAnyThreads) {
  Image<float> fine({101, 67});
  for (int y = 0; y < 67; ++y) {
    for (int x = 0; x < 101; ++x) fine(x, y) = std::sin(0.3F * static_cast<float>(x * y));
  }
  Image<float> one({40, 30}), three({40, 30});
  reduce(fine.plane(), Averaging::kSquares, 1, one.plane());
  reduce(fine.plane(), Averaging::kSquares, 3, three.plane());
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) ASSERT_EQ(one(x, y), three(x, y));
  }
}

TEST(MipLevels, EndAtOnePixelAndKeepNormalsOfTwoPartsOnTheSphere) {
  TestMaps maps({6, 5});
  maps.set_slopes([](int x, int y) { return std::array<double, 2>{0.5 * x, -0.3 * y}; });
  const PresetFile file = file_of({"normal.x", "normal.y"});
  Image<float> level(maps.size(), 2);
  pack_values(file, maps.planes(), {}, 0, TestMaps::views_of(level));
  std::vector<Size> sizes;
  while (level.size() != Size{1, 1}) {
    level = next_level(file, level, 1);
    sizes.push_back(level.size());
  }
  EXPECT_EQ(sizes, (std::vector<Size>{{3, 2}, {1, 1}}));
  EXPECT_LT(std::hypot(level(0, 0, 0), level(0, 0, 1)), 1);
  // Slopes of x are 0.5 times 0 to 5: their mean is 1.25.
  const double z = std::sqrt(1 - std::pow(static_cast<double>(level(0, 0, 0)), 2) -
                             std::pow(static_cast<double>(level(0, 0, 1)), 2));
  EXPECT_NEAR(-static_cast<double>(level(0, 0, 0)) / z, 1.25, 1e-4);
}

}  // namespace
}  // namespace weft::exchange
