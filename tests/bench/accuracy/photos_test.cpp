// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/photos.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace weft::bench {
namespace {

// The zenith, then four lights 60 degrees away from it, at 0, 90, 180 and 270 degrees, and one close to the
// second.
const std::vector<Vec3> kLights = {{0, 0, 1},
                                   {0.8660254, 0, 0.5},
                                   {0, 0.8660254, 0.5},
                                   {-0.8660254, 0, 0.5},
                                   {0, -0.8660254, 0.5},
                                   {0.8480481, 0, 0.5299192}};

TEST(SpreadLights, TakesTheFarthestOfAllThatAreChosen) {
  EXPECT_EQ(spread_lights(kLights, 2, 2), (std::vector<int>{2, 4})) << "the opposite one";
  EXPECT_EQ(spread_lights(kLights, 5, 2), (std::vector<int>{2, 4, 3, 5, 1})) << "the near twin comes last";
  EXPECT_EQ(spread_lights(kLights, 6, 2).back(), 6);
}

TEST(SpreadLights, StopsWhereTheRestRepeatsWhatIsChosen) {
  const std::vector<Vec3> twins = {{0, 0, 1}, {0, 0, 1}, {1, 0, 0}};
  EXPECT_EQ(spread_lights(twins, 3, 1), (std::vector<int>{1, 3}));
}

TEST(FirstLights, AreEveryLightOnceBeforeAnyComesAgain) {
  std::vector<int> first = first_lights(96, 96, 1), all(96);
  EXPECT_NE(first, first_lights(96, 96, 2)) << "another seed, another order";
  const std::vector<int> longer = first_lights(96, 100, 1);
  EXPECT_TRUE(std::equal(first.begin(), first.end(), longer.begin()));
  EXPECT_EQ(longer[96], first[0]);
  std::sort(first.begin(), first.end());
  std::iota(all.begin(), all.end(), 1);
  EXPECT_EQ(first, all);
}

TEST(PhotosTable, RefusesAFolderThatIsNotThere) {
  PhotosOptions options;
  options.folder = testing::TempDir() + "no-such-folder";
  const auto rows = photos_table(options);
  ASSERT_FALSE(rows.has_value());
  EXPECT_EQ(rows.error().kind, ErrorKind::kNoInput) << rows.error().message();
}

TEST(PhotosTable, RefusesAMethodThatIsNotThereByName) {
  PhotosOptions options;
  options.methods = {"fastest"};
  const auto rows = photos_table(options);
  ASSERT_FALSE(rows.has_value());
  EXPECT_EQ(rows.error().kind, ErrorKind::kUsage);
  EXPECT_EQ(rows.error().where, "fastest");
}

}  // namespace
}  // namespace weft::bench
