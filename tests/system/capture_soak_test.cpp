// SPDX-License-Identifier: Apache-2.0
// What `weft bench capture` prints, on a virtual rig of its own.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "tests/core/places.h"
#include "virtual_rig/rig_process.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

class CaptureSoak : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// The rows of `weft bench capture --part PART --runs N`.
  Json rows(const std::string& part, int runs, double megapixels, double most_s) {
    const auto rig = virtual_rig::RigProcess::start({.programs = program_folder(),
                                                     .scene = source_folder() / "testdata/scenes/satin.toml",
                                                     .folder = folder_ / "rig",
                                                     .megapixels = megapixels,
                                                     .same_noise = true});
    EXPECT_TRUE(rig) << rig.error().message();
    if (!rig) return Json::array();
    const auto weft = (*rig)->weft(
        {"bench", "capture", "--part", part, "--runs", std::to_string(runs), "--json", "-q"}, "bench.log");
    EXPECT_TRUE(weft) << weft.error().message();
    if (!weft) return Json::array();
    const std::optional<int> code = (*weft)->wait(most_s);
    EXPECT_EQ(code, 0) << (*weft)->said();
    Json document = Json::parse((*weft)->said(), nullptr, false);
    EXPECT_TRUE(document.contains("rows")) << (*weft)->said();
    return document.value("rows", Json::array());
  }

  /// No frame of these scans differs, and neither weft nor weft-camera grows after the first tenth.
  void expect_flat(const Json& rows) {
    ASSERT_GT(rows.size(), 3u);
    const Json &early = rows[2], &last = rows.back();
    EXPECT_EQ(last["frames_that_differ"], 0);
    EXPECT_EQ(last["descriptors"], early["descriptors"]);
    EXPECT_EQ(last["camera_descriptors"], early["camera_descriptors"]);
    for (const char* memory : {"resident_mb", "camera_resident_mb"}) {
      EXPECT_LT(last[memory].get<double>(), 1.05 * early[memory].get<double>() + 4) << memory;
    }
  }

  fs::path folder_;
};

TEST_F(CaptureSoak, TenThousandBoardCommandsAreAnswered) {
  const Json all = rows("board", 10'000, 0.2, 300);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0]["lost"], 0);
}

TEST_F(CaptureSoak, FiveHundredScansAreAlikeAndLeaveNothingBehind) {
  expect_flat(rows("scans", 500, 1, 7200));
}

TEST_F(CaptureSoak, TwentyScansOfSixteenMegapixelsAreAlikeAndLeaveNothingBehind) {
  expect_flat(rows("scans", 20, 16, 1200));
}

// A LED may be lit for 40 s at once and half of the time. The third photograph of LED 1 within two minutes,
// after one that was truncated, asks for more than that.
TEST_F(CaptureSoak, ExposuresOf25SecondsWaitForTheLedToCool) {
  const auto rig = virtual_rig::RigProcess::start({.programs = program_folder(),
                                                   .scene = source_folder() / "testdata/scenes/satin.toml",
                                                   .folder = folder_ / "rig",
                                                   .megapixels = 0.05});
  ASSERT_TRUE(rig) << rig.error().message();
  ASSERT_TRUE((*rig)->say("camera short_data 2"));
  const auto weft = (*rig)->weft(
      {"scan", "--leds", "1", "--exposure", "25000000", "--fabric", "long", "--no-preview"}, "scan.log");
  ASSERT_TRUE(weft) << weft.error().message();
  EXPECT_EQ((*weft)->wait(300), 0) << (*weft)->said();
  EXPECT_NE((*weft)->said().find("LED 1 cools, "), std::string::npos) << (*weft)->said();
  EXPECT_EQ((*weft)->said().find("went out"), std::string::npos) << (*weft)->said();
}

}  // namespace
}  // namespace weft
