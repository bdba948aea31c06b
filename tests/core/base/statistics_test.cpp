// SPDX-License-Identifier: Apache-2.0
#include "core/base/statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace weft {
namespace {

TEST(Statistics, GivesTheMiddleValueAndOfAnEvenNumberTheUpperOne) {
  EXPECT_EQ(median(std::vector<double>{3, 1, 2}), 2);
  EXPECT_EQ(median(std::vector<double>{4, 1, 3, 2}), 3);
  EXPECT_EQ(median(std::vector<int>{7}), 7);
}

TEST(Statistics, GivesOneOfTheValuesForAnyShare) {
  const std::vector<double> values = {50, 10, 40, 20, 30};
  EXPECT_EQ(quantile(values, 0), 10);
  EXPECT_EQ(quantile(values, 0.25), 20);
  EXPECT_EQ(quantile(values, 0.3), 20);
  EXPECT_EQ(quantile(values, 0.4), 30);
  EXPECT_EQ(quantile(values, 1), 50);
}

TEST(Statistics, RoundsARankDownWhereTheLowerValueIsAskedFor) {
  const std::vector<double> values = {50, 10, 40, 20, 30};
  EXPECT_EQ(lower_quantile(values, 0.4), 20);
  EXPECT_EQ(lower_quantile(values, 0.5), 30);
  EXPECT_EQ(lower_quantile(values, 0.99), 40);
  EXPECT_EQ(lower_quantile(values, 1), 50);
  EXPECT_EQ(lower_quantile(std::vector<int>{4, 1, 3, 2}, 0.5), 2);
}

TEST(Statistics, KeepsTheValuesOfARankAmongTheOthers) {
  std::vector<double> values = {50, 10, 40, 20, 30};
  EXPECT_EQ(value_of_rank<double>(values, 3), 40);
  EXPECT_THAT(values, testing::UnorderedElementsAre(10, 20, 30, 40, 50));
}

TEST(Statistics, LeavesOutWhatIsNotFinite) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  EXPECT_THAT(finite(std::vector<double>{1, nan, 2, infinity, -infinity}), testing::ElementsAre(1, 2));
}

TEST(Statistics, HasNoValueOfNothing) {
  EXPECT_TRUE(std::isnan(quantile(std::vector<double>(), 0.5)));
  EXPECT_TRUE(std::isnan(lower_quantile(std::vector<double>(), 0.5)));
  EXPECT_TRUE(std::isnan(median(std::vector<float>())));
}

}  // namespace
}  // namespace weft
