// SPDX-License-Identifier: Apache-2.0
#include "library/batch/change.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace weft::library {
namespace {

MapChange turned(double p95_deg) {
  MapChange change;
  change.mean_deg = p95_deg / 2;
  change.p95_deg = p95_deg;
  change.max_deg = 2 * p95_deg;
  return change;
}

TEST(MapChange, IsWorseWhereSigmaGrewByATenth) {
  MapChange change = turned(1);
  change.sigma_deg = {1.0, 1.09};
  EXPECT_THAT(regressions(change), testing::IsEmpty());
  change.sigma_deg = {1.0, 1.5};
  EXPECT_THAT(regressions(change), testing::ElementsAre("sigma 1 to 1.5 degrees"));
  EXPECT_NEAR(regression_weight(change), 1.5, 1e-3);
}

TEST(MapChange, IsWorseWhereMorePixelsHaveNoSolution) {
  MapChange change = turned(1);
  change.unsolved = {0.01, 0.0105};
  EXPECT_THAT(regressions(change), testing::IsEmpty());
  change.unsolved = {0, 0.02};
  EXPECT_THAT(regressions(change), testing::ElementsAre("unsolved 0.00 to 2.00 percent"));
}

TEST(MapChange, ThatIsBetterInAllIsNoRegression) {
  MapChange change = turned(20);
  change.sigma_deg = {2, 0.5};
  change.unsolved = {0.1, 0};
  change.left_out = {0.2, 0.05};
  EXPECT_THAT(regressions(change), testing::IsEmpty());
  EXPECT_EQ(regression_weight(change), 0);
}

TEST(MapChange, PutsRegressionsBeforeWhatTurnedFurther) {
  MapChange worse = turned(0.5), far = turned(9), farther = turned(10);
  worse.left_out = {0.05, 0.10};
  EXPECT_TRUE(is_graver(worse, farther));
  EXPECT_FALSE(is_graver(farther, worse));
  EXPECT_TRUE(is_graver(farther, far));
  EXPECT_FALSE(is_graver(far, far));
}

TEST(MapChange, OfNoPixelSaysSo) {
  EXPECT_TRUE(MapChange().is_none());
  EXPECT_FALSE(turned(1e-3).is_none());
}

}  // namespace
}  // namespace weft::library
