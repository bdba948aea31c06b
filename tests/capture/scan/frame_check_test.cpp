// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/frame_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace weft::capture {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Photograph photograph(std::uint32_t number, std::optional<double> taken_s = 1000.1) {
  Photograph p;
  p.file = "01_led01.dng";
  p.image_number = number;
  p.taken_s = taken_s;
  return p;
}

ImageCount followed(std::optional<std::uint32_t> last) {
  ImageCount count;
  count.follow(last);
  return count;
}

std::string objection(ImageCount& count, const Photograph& p) {
  const Result<void> ok = count.check(p);
  return ok ? "" : ok.error().why;
}

TEST(ImageCount, TakesPhotographsThatFollowOneAnother) {
  ImageCount count;
  for (const std::uint32_t number : {70u, 71u, 72u}) EXPECT_EQ(objection(count, photograph(number)), "");
}

TEST(ImageCount, RefusesThePhotographBefore) {
  ImageCount count;
  EXPECT_EQ(objection(count, photograph(70)), "");
  EXPECT_THAT(objection(count, photograph(70)), HasSubstr("70 was there before"));
  EXPECT_EQ(objection(count, photograph(71)), "") << "the count goes on from the last good one";
}

TEST(ImageCount, RefusesAGapUnlessItsOwnFailuresExplainIt) {
  ImageCount count;
  EXPECT_EQ(objection(count, photograph(70)), "");
  EXPECT_THAT(objection(count, photograph(72)), HasSubstr("somebody else released the shutter"));
  count.failed();
  EXPECT_EQ(objection(count, photograph(74)), "") << "the failed take may have counted";
  EXPECT_EQ(objection(count, photograph(75)), "") << "and a count that it did not take is no fault";
}

TEST(ImageCount, KnowsThatTheCameraMayHaveBeenUsedBetweenTwoScans) {
  ImageCount count = followed(70);
  EXPECT_EQ(objection(count, photograph(90)), "");
}

TEST(ImageCount, BelievesABodyThatCountsAnewOnlyByItsTime) {
  ImageCount count = followed(70);
  EXPECT_NE(objection(count, photograph(3, std::nullopt)), "");
  count.connected();
  EXPECT_EQ(objection(count, photograph(3)), "");
  EXPECT_NE(objection(count, photograph(3)), "") << "within a connection it only rises";
  EXPECT_EQ(objection(count, photograph(4)), "");
  count.connected();
  EXPECT_EQ(objection(count, photograph(1)), "") << "reset in the middle of a scan";
}

std::vector<std::string> warnings_of(const std::vector<std::pair<double, double>>& exposures_and_waits_s) {
  LongWaits waits;
  for (const auto& [exposure_s, waited_s] : exposures_and_waits_s) {
    Photograph taken;
    taken.exposure.exposure_us = 1e6 * exposure_s;
    taken.waited_s = waited_s;
    waits.note(taken);
  }
  std::vector<std::string> warnings;
  waits.warn(warnings);
  return warnings;
}

TEST(LongWaits, TellNoiseReductionByAllLongExposuresThatTakeTwiceTheirTime) {
  EXPECT_THAT(warnings_of({{2, 4.3}, {2, 4.1}, {4, 9}}),
              ElementsAre(HasSubstr("photographs of 2 s come after 4.1 s")));
  EXPECT_THAT(warnings_of({{2, 4.3}, {2, 3.2}}), IsEmpty()) << "a card that was slow once";
  EXPECT_THAT(warnings_of({{0.5, 1.2}, {1, 2.2}}), IsEmpty()) << "no noise is reduced";
  EXPECT_THAT(warnings_of({}), IsEmpty());
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

TEST(CheckNew, RefusesAFileThatAnotherShotHasAndNamesIt) {
  Shot kept;
  kept.file = "raw/00_led00.dng";
  kept.sha256 = "ab";
  Photograph p = photograph(70);
  p.sha256 = "ab";
  const Result<void> twice = check_new(p, {kept}, "LED 1 (01_led01)");
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().kind, ErrorKind::kProtocol);
  EXPECT_THAT(twice.error().message(), HasSubstr("LED 1 (01_led01): the file is that of raw/00_led00.dng"));
  p.sha256 = "cd";
  EXPECT_TRUE(check_new(p, {kept}, "LED 1 (01_led01)"));
}

}  // namespace
}  // namespace weft::capture
