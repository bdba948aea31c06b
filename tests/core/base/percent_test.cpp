// SPDX-License-Identifier: Apache-2.0
#include "core/base/percent.h"

#include <gtest/gtest.h>

namespace weft {
namespace {

TEST(Percent, HasTwoDigitsAndNeverPowersOfTen) {
  EXPECT_EQ(percent_words(0), "0");
  EXPECT_EQ(percent_words(4e-6), "under 0.001");
  EXPECT_EQ(percent_words(2.6e-4), "0.026");
  EXPECT_EQ(percent_words(0.02), "2");
  EXPECT_EQ(percent_words(0.0949), "9.5");
  EXPECT_EQ(percent_words(0.0951), "10");
  EXPECT_EQ(percent_words(0.999), "100");
  EXPECT_EQ(percent_words(5.62), "562");
}

}  // namespace
}  // namespace weft
