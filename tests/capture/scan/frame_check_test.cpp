// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/frame_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace weft::capture {
namespace {

using testing::HasSubstr;

constexpr ExposureSettings kAsked = {20000, 100, 8};

Photograph photograph(std::uint32_t number, double taken_s = 1000.1) {
  Photograph p;
  p.file = "01_led01.dng";
  p.image_number = number;
  p.taken_s = taken_s;
  p.triggered_s = 1000;
  p.exposure = kAsked;
  return p;
}

PhotographCheck begun(std::optional<std::uint32_t> last = {}) {
  PhotographCheck check;
  check.begin(0.05, last);
  return check;
}

std::string objection(PhotographCheck& check, const Photograph& p, double now_s = 1001) {
  const Result<void> ok = check.check(p, kAsked, now_s);
  return ok ? "" : ok.error().why;
}

TEST(PhotographCheck, TakesPhotographsThatFollowOneAnother) {
  PhotographCheck check = begun();
  for (const std::uint32_t number : {70u, 71u, 72u}) EXPECT_EQ(objection(check, photograph(number)), "");
}

TEST(PhotographCheck, RefusesThePhotographBefore) {
  PhotographCheck check = begun();
  EXPECT_EQ(objection(check, photograph(70)), "");
  EXPECT_THAT(objection(check, photograph(70)), HasSubstr("70 was there before"));
  EXPECT_EQ(objection(check, photograph(71)), "") << "the count goes on from the last good one";
}

TEST(PhotographCheck, RefusesAGapUnlessItsOwnFailuresExplainIt) {
  PhotographCheck check = begun();
  EXPECT_EQ(objection(check, photograph(70)), "");
  EXPECT_THAT(objection(check, photograph(72)), HasSubstr("somebody else released the shutter"));
  check.failed();
  EXPECT_EQ(objection(check, photograph(74)), "") << "the failed take may have counted";
  EXPECT_EQ(objection(check, photograph(75)), "") << "and a count that it did not take is no fault";
}

TEST(PhotographCheck, KnowsThatTheCameraMayHaveBeenUsedBetweenTwoScans) {
  PhotographCheck check = begun(70);
  EXPECT_EQ(objection(check, photograph(90)), "");
  PhotographCheck other = begun(70);
  EXPECT_NE(objection(other, photograph(70)), "") << "but not its own frames again";
}

TEST(PhotographCheck, RefusesAnotherTimeBeyondTheClocks) {
  PhotographCheck check = begun();
  EXPECT_EQ(objection(check, photograph(70, 999.96)), "");
  EXPECT_THAT(objection(check, photograph(71, 999.9)), HasSubstr("before it was asked for"));
  EXPECT_THAT(objection(check, photograph(72, 1001.1)), HasSubstr("after now"));
  EXPECT_EQ(objection(check, photograph(73, 1001.04)), "");
}

TEST(PhotographCheck, RefusesAnotherExposure) {
  PhotographCheck check = begun();
  Photograph p = photograph(70);
  p.exposure.exposure_us = 25000;
  EXPECT_THAT(objection(check, p), HasSubstr("25000 us"));
  p = photograph(71);
  p.exposure.iso = 200;
  EXPECT_THAT(objection(check, p), HasSubstr("ISO 200"));
  p = photograph(72);
  p.exposure = {20100, 0, 0};
  EXPECT_EQ(objection(check, p), "") << "what the file does not say is not compared";
}

TEST(FrameCheck, NamesWhatDiffersFromTheFirstFrame) {
  const auto frame = [] {
    return RawFrame{
        Image<std::uint16_t>({8, 6}), {}, {{{600, 600}, {600, 600}}}, 15520, {"Make", "Model", "1", 0, 0, 0}};
  };
  const RawFrame first = frame();
  EXPECT_TRUE(check_alike(frame(), first, {8, 6}, "x"));
  EXPECT_THAT(check_alike(frame(), first, {8, 8}, "x").error().why, HasSubstr("8 x 6 pixels"));
  RawFrame other = frame();
  other.cfa.site = {{{2, 3}, {1, 0}}};
  EXPECT_THAT(check_alike(other, first, {8, 6}, "x").error().why, HasSubstr("colour filters"));
  other = frame();
  other.black[0][1] = 0;
  EXPECT_THAT(check_alike(other, first, {8, 6}, "x").error().why, HasSubstr("black or white"));
  other = frame();
  other.shot.serial = "2";
  EXPECT_THAT(check_alike(other, first, {8, 6}, "x").error().why, HasSubstr("serial number 2"));
}

}  // namespace
}  // namespace weft::capture
