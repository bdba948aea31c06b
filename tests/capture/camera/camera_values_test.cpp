// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/camera_setup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace weft::capture {
namespace {

TEST(CameraValues, ReadShutterTimesInEveryForm) {
  EXPECT_DOUBLE_EQ(*shutter_us_of("1/60"), 1e6 / 60);
  EXPECT_DOUBLE_EQ(*shutter_us_of("10/25"), 4e5);
  EXPECT_DOUBLE_EQ(*shutter_us_of("1.3"), 1.3e6);
  EXPECT_DOUBLE_EQ(*shutter_us_of("0.0166s"), 16600);
  EXPECT_DOUBLE_EQ(*shutter_us_of("30"), 3e7);
  for (const char* none : {"Bulb", "", "s", "1/", "/2", "1/0", "-1", "0", "nan", "inf", "1/60x"})
    EXPECT_FALSE(shutter_us_of(none)) << none;
}

TEST(CameraValues, ReadIsoAndAperture) {
  EXPECT_EQ(number_of("f/5.6"), 5.6);
  EXPECT_EQ(number_of("100"), 100);
  EXPECT_FALSE(number_of("Auto"));
}

TEST(CameraValues, ChooseTheNearestWithinAPercentAndNameTheSidesElse) {
  const auto choices = choices_of({"1/50", "Bulb", "1/100", "1/60"}, &shutter_us_of);
  ASSERT_EQ(choices.size(), 3U);
  EXPECT_EQ(choices.front().text, "1/100");
  const auto near = nearest_choice(choices, 16700, "exposure in us");
  ASSERT_TRUE(near) << near.error().message();
  EXPECT_EQ(near->text, "1/60");
  const auto between = nearest_choice(choices, 18000, "exposure in us");
  ASSERT_FALSE(between);
  EXPECT_EQ(between.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(between.error().why, testing::HasSubstr("1/60 and 1/50"));
  EXPECT_THAT(nearest_choice(choices, 1e6, "exposure in us").error().why, testing::HasSubstr("are 1/50"));
  EXPECT_THAT(nearest_choice({}, 1e6, "exposure in us").error().why, testing::HasSubstr("lists none"));
}

}  // namespace
}  // namespace weft::capture
