// SPDX-License-Identifier: Apache-2.0
// Folders of many frames: clocks that were set meanwhile, files that are there twice, and what is odd said
// once.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "tests/system/import_bench.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf, testing::HasSubstr, testing::Not;

class ManyFrames : public ImportBench {
 protected:
  /// So many sessions one after the other under names that count on; `clock` is what a camera's clock shows.
  void put_sessions(int sessions, const std::function<double(int frame, double second)>& clock) const {
    for (int i = 0; i < 11 * sessions; ++i)
      put(fmt::format("flat/DSC_{:04}.dng", 120 + i), i % 11, clock(i, 400.0 * (i / 11) + 2 * (i % 11)));
  }
  void expect_whole_sessions(int sessions) const {
    for (int s = 1; s <= sessions; ++s) {
      const Session made = session(sessions == 1 ? "flat" : fmt::format("flat_{:02}", s));
      ASSERT_EQ(made.shots.size(), 11U) << s;
      for (int i = 0; i < 11; ++i) {
        EXPECT_EQ(made.shots[static_cast<std::size_t>(i)].led, i) << "in order of the counter";
        EXPECT_EQ(made.shots[static_cast<std::size_t>(i)].document["source"],
                  fmt::format("flat/DSC_{:04}.dng", 120 + 11 * (s - 1) + i));
      }
      expect_right(made);
    }
  }
  static std::string doubts(const Json& plan) {
    std::string all;
    for (const Json& session : plan["sessions"]) all += session["warnings"].dump();
    return all;
  }
};

TEST_F(ManyFrames, OneFileUnderTwoLedsIsRefusedByBothNames) {
  put_by_number("tray", all_leds());
  const auto copy_over = [&](const std::string& from, const std::string& to) {
    fs::copy_file(source_ / "tray" / from, source_ / "tray" / to, fs::copy_options::overwrite_existing);
  };
  copy_over("satin_05.DNG", "satin_03.DNG");
  refused(by_number_, {"two frames are one photograph",
                       "tray/satin_03.DNG and tray/satin_05.DNG are one file, byte for byte",
                       "take the copy out, and look for the frame in whose place it is"});
  const auto clip = [](RawFrame& frame) {
    for (int y = 0; y < frame.counts.height() / 2; ++y)
      std::fill_n(frame.counts.plane().row(y), frame.counts.width(), static_cast<std::uint16_t>(frame.white));
  };
  for (const int led : all_leds(false)) put(fmt::format("tray/satin_{:02}.DNG", led), led, {}, clip);
  copy_over("satin_05.DNG", "satin_03.DNG");
  refused(by_number_, {"satin_03.DNG and tray/satin_05.DNG are one file, byte for byte"});
}

TEST_F(ManyFrames, AClockThatIsSetBackInTheMidstReordersNothingAndIsTold) {
  put_sessions(1, [](int frame, double second) { return frame < 6 ? second : second - 3600; });
  const Json plan = imported();
  EXPECT_EQ(plan["sessions"][0]["by"], "names");
  EXPECT_THAT(doubts(plan), HasSubstr("the camera's clock went back by 3598 s between flat/DSC_0125.dng and "
                                      "flat/DSC_0126.dng: the order is that of names, which count on"));
  EXPECT_THAT(session("flat").document["warnings"].dump(), HasSubstr("went back by 3598 s"));
  expect_whole_sessions(1);
}

TEST_F(ManyFrames, AClockThatIsSetInTheMidstOfASessionPartsNoneOfMany) {
  for (const double by_s : {-3600, 3600, -200}) {
    SCOPED_TRACE(by_s);
    fs::remove_all(archive_);
    put_sessions(3, [&](int frame, double second) { return frame < 11 + 4 ? second : second + by_s; });
    const Json plan = imported();
    EXPECT_EQ(plan["imported"], 3);
    EXPECT_THAT(doubts(plan), HasSubstr(by_s < 0 ? "the camera's clock went back by"
                                                 : "lie over 60 s, and the camera counted on: one session"));
    EXPECT_THAT(doubts(plan), AllOf(HasSubstr("flat/DSC_0134.dng"), HasSubstr("flat/DSC_0135.dng")));
    expect_whole_sessions(3);
  }
}

TEST_F(ManyFrames, AClockThatBeginsAnewWithEachSessionMixesNone) {
  put_sessions(4, [](int frame, double) { return 2.0 * (frame % 11); });
  const Json plan = imported();
  EXPECT_EQ(plan["imported"], 4);
  EXPECT_THAT(doubts(plan), HasSubstr("while its counter went on"));
  expect_whole_sessions(4);
}

TEST_F(ManyFrames, AFrameWithoutATimeStaysWhereItsNumberIs) {
  put_sessions(2, [](int, double second) { return second; });
  put("flat/DSC_0125.dng", 5);
  EXPECT_EQ(imported()["imported"], 2);
  expect_whole_sessions(2);
}

TEST_F(ManyFrames, OneWithoutATimeIsNamedWhereNothingElseTellsSessionsApart) {
  put_all("flat/A{:02}.dng", all_leds(), 3, 0);
  put_all("flat/B{:02}.dng", all_leds(), 3, 400);
  put("flat/B12.dng", 4);
  refused({}, {"more frames than LEDs", "gaps tell nothing of 1 without a time: flat/B12.dng"});
}

TEST_F(ManyFrames, FramesOfAnotherSettingAreNamedTogetherAndNotTheirMajority) {
  for (const int led : all_leds()) {
    put(fmt::format("tray/satin_{:02}.DNG", led), led, {}, [&](RawFrame& frame) {
      if (led < 2 || led > 7) frame.shot.iso *= 4;
    });
  }
  refused({}, {"not of one session, by their ISO value",
               "tray/satin_00.DNG, tray/satin_01.DNG, tray/satin_08.DNG and 2 more"});
}

TEST_F(ManyFrames, OddOnesOfAKindAreSaidInOneSentenceAndAskedAboutOnce) {
  const int sessions = 16;
  put_by_number("tray_00", all_leds());
  put("odd.DNG", 3, {}, [](RawFrame& frame) { frame.shot.iso *= 4; });
  fs::rename(source_ / "odd.DNG", work_ / "odd.DNG");
  for (int s = 1; s < sessions; ++s) {
    const fs::path folder = source_ / fmt::format("tray_{:02}", s);
    fs::copy(source_ / "tray_00", folder);
    if (s >= 8 && s < 12)
      fs::copy_file(work_ / "odd.DNG", folder / "satin_03.DNG", fs::copy_options::overwrite_existing);
    if (s >= 12) fs::remove(folder / "satin_07.DNG");
    for (const char* name : {"a.JPG", "b.JPG"}) put_bytes(folder / name, "\xff\xd8\xff");
  }
  type("n\n");
  const Outcome asked = run_weft(words({}));
  EXPECT_EQ(asked.exit_code, 64);
  EXPECT_THAT(asked.error,
              HasSubstr("import into " + archive_.string() + ": 8 sessions, without the 8 refused? [y/N]"));
  EXPECT_THAT(
      asked.output,
      AllOf(HasSubstr("4 sessions are refused: photographs are not of one session, by their ISO value: "
                      "tray_08.weft, tray_09.weft, tray_10.weft and tray_11.weft. To do: put those"),
            HasSubstr("4 sessions are refused: frames are missing: tray_12.weft"),
            HasSubstr("30 files are left over: a JPEG went through the camera's tone curve: "),
            HasSubstr("and 27 more."), HasSubstr("9 more sessions, all in --json")));
  EXPECT_LT(std::ranges::count(asked.output, '\n'), 5 * 15 + 3 * 15) << "not a line a frame";

  const Outcome run = import();
  const Json plan = run.json();
  EXPECT_EQ(plan["imported"], 8);
  ASSERT_EQ(plan["oddities"].size(), 3U);
  EXPECT_EQ(plan["oddities"][2]["kind"], "left_over");
  EXPECT_EQ(plan["oddities"][2]["count"], 30);
  EXPECT_THAT(plan["oddities"][0]["says"].get<std::string>(), HasSubstr("4 sessions are refused"));
  EXPECT_EQ(plan["left_over"].size(), 30U) << "each file is there all the same";
}

}  // namespace
}  // namespace weft::test
