// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/poses_price.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace weft::calibration {
namespace {

using testing::HasSubstr;

// 0.3 degrees by what is there, and 25 seconds a pose.
PosesPrices prices_of(std::vector<double> degrees) {
  PosesPrices prices = {"sheet", {}};
  for (std::size_t i = 0; i < degrees.size(); ++i) {
    PosesPrice price = {.more = kMorePoses[i], .poses = 2 + kMorePoses[i], .rig_s = 25.0 * kMorePoses[i]};
    price.predicted_deg = degrees[i];
    prices.rows.push_back(price);
  }
  return prices;
}

PosesWish wish_of(std::optional<double> to_deg, std::optional<double> within_s) {
  PosesWish wish;
  wish.to_deg = to_deg;
  wish.within_s = within_s;
  return wish;
}

int chosen_of(PosesPrices prices, const PosesWish& wish) {
  const Result<void> ok = choose_poses(prices, wish);
  EXPECT_TRUE(ok) << ok.error().message();
  EXPECT_EQ(std::ranges::count_if(prices.rows, &PosesPrice::is_chosen), 1);
  return std::ranges::find_if(prices.rows, &PosesPrice::is_chosen)->more;
}

TEST(PosesPrice, IsOfTheFewestThatSuffice) {
  const PosesPrices prices = prices_of({0.3, 0.12, 0.06, 0.031, 0.030});
  EXPECT_EQ(chosen_of(prices, {}), 5) << "ten more are not 5 percent better";
  EXPECT_EQ(chosen_of(prices, wish_of(0.1, {})), 2);
  EXPECT_EQ(chosen_of(prices, wish_of(0.5, {})), 0);
  EXPECT_EQ(chosen_of(prices, wish_of({}, 60)), 2);
  EXPECT_EQ(chosen_of(prices, wish_of(0.2, 60)), 1);
  EXPECT_EQ(chosen_of(prices, wish_of({}, 0)), 0) << "what is there takes no time at the rig";
  EXPECT_EQ(chosen_of(prices_of({0.3, 0.3, 0.3, 0.3, 0.3}), {}), 0);
}

TEST(PosesPrice, SaysTheBestWhereNoneSuffice) {
  PosesPrices prices = prices_of({0.3, 0.12, 0.06, 0.031, 0.030});
  const Result<void> refused = choose_poses(prices, wish_of(0.01, {}));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(refused.error().message(), HasSubstr("the best by ten more poses is 0.03 degrees"));
}

}  // namespace
}  // namespace weft::calibration
