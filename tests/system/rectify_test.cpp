// SPDX-License-Identifier: Apache-2.0
// Maps of a small session on a square grid of its table.
#include "material/run/rectify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "core/image_io/image_io.h"
#include "solve/run/solve_session.h"
#include "tests/system/session_test.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using material::rectify_session;
using material::RectifyOptions;
using material::RectifyReport;
using testing::HasSubstr;

class Rectify : public SessionTest {
 protected:
  /// The folder of a solve by this method.
  fs::path solve(const std::string& method) const {
    solve::SolveOptions options;
    options.method = method;
    options.previews = false;
    const auto report =
        solve::solve_session({.folder = session_, .calibration = {}, .leds = {}}, options, {});
    EXPECT_TRUE(report) << report.error().message();
    return report ? report->folder : fs::path();
  }
  RectifyReport rectified(const RectifyOptions& options) const {
    const auto report = rectify_session(options, {});
    EXPECT_TRUE(report) << report.error().message();
    return report ? *report : RectifyReport();
  }
  RectifyOptions options() const {
    RectifyOptions options;
    options.session = session_;
    return options;
  }
};

TEST_F(Rectify, WritesTheSameBytesForAnyBandsAndThreadsAndDoesNothingTwice) {
  solve("fast");
  RectifyOptions in_bands = options();
  in_bands.output = work_ / "bands";
  in_bands.band_rows = 3;
  RectifyOptions at_once = options();
  at_once.output = work_ / "once";
  at_once.band_rows = 1000;
  ASSERT_TRUE(rectify_session(in_bands, {.threads = 1}));
  ASSERT_TRUE(rectify_session(at_once, {.threads = 3}));
  EXPECT_EQ(contents_of(work_ / "bands"), contents_of(work_ / "once"));
  const RectifyReport first = rectified(options()), second = rectified(options());
  EXPECT_FALSE(first.was_there);
  EXPECT_TRUE(second.was_there);
  EXPECT_EQ(first.folder.parent_path(), session_ / "rectified");
  EXPECT_EQ(contents_of(first.folder), contents_of(work_ / "once"));
}

TEST_F(Rectify, SaysWhereItsPixelsLie) {
  const fs::path solved = solve("fast");
  RectifyOptions turned = options();
  turned.mm_per_pixel = 0.1;
  turned.turn_deg = 90;
  const RectifyReport report = rectified(turned);
  const material::RectifyFacts& d = report.facts;
  EXPECT_EQ(d.source.solve, solved.filename().string());
  EXPECT_EQ(d.mm_per_pixel, 0.1);
  EXPECT_EQ(d.turn_deg, 90);
  const auto normal = read_image(report.folder / "normal.exr"),
             albedo = read_image(report.folder / "albedo.exr");
  const auto sigma = read_image(report.folder / "sigma.exr"),
             status = read_image(report.folder / "status.png");
  ASSERT_TRUE(normal && albedo && sigma && status);
  for (const auto* map : {&normal, &albedo, &sigma, &status}) {
    EXPECT_EQ((*map)->info.size.width, d.size.width);
    EXPECT_EQ((*map)->info.size.height, d.size.height);
  }
  for (int y = 0; y < normal->info.size.height; ++y) {
    for (int x = 0; x < normal->info.size.width; ++x) {
      const auto n = [&](int p) { return static_cast<double>(normal->planes(x, y, p)); };
      ASSERT_NEAR(std::hypot(n(0), n(1), n(2)), 1, 1e-5);
    }
  }
}

TEST_F(Rectify, TakesTheCurrentSolveAndHalfSizeMapsOfThePreviewToo) {
  const fs::path fast = solve("fast"), preview = solve("preview");
  fs::last_write_time(fast / "solve.json",
                      fs::last_write_time(preview / "solve.json") - std::chrono::hours(1));
  const RectifyReport current = rectified(options());
  EXPECT_EQ(current.facts.source.solve, fast.filename().string())
      << "a preview that is newer does not become it";
  RectifyOptions named = options();
  named.solve = preview.filename().string();
  const auto refused = rectify_session(named, {});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().remedy, HasSubstr("--draft"));
  named.is_draft = true;
  const RectifyReport half = rectified(named);
  EXPECT_EQ(half.facts.source.solve, preview.filename().string());
  EXPECT_NEAR(half.facts.mm_per_pixel / current.facts.mm_per_pixel, 2, 1e-3);
}

TEST_F(Rectify, RefusesInWordsAndLeavesNothingBehind) {
  const auto expect_refused = [&](const RectifyOptions& refused, ErrorKind kind, const std::string& words) {
    const auto before = contents_of(work_.path());
    const auto report = rectify_session(refused, {});
    ASSERT_FALSE(report) << words;
    EXPECT_EQ(report.error().kind, kind) << report.error().message();
    EXPECT_THAT(report.error().message(), HasSubstr(words));
    EXPECT_EQ(contents_of(work_.path()), before);
  };
  expect_refused(options(), ErrorKind::kNoInput, "weft solve");
  const fs::path solved = solve("fast");
  RectifyOptions wrong = options();
  wrong.solve = "0123";
  expect_refused(wrong, ErrorKind::kNoInput, "0123");
  wrong.solve = "../solve/" + solved.filename().string();
  expect_refused(wrong, ErrorKind::kNoInput, "no complete solve");
  wrong = options();
  wrong.mm_per_pixel = -1;
  expect_refused(wrong, ErrorKind::kUsage, "mm_per_pixel");
  wrong.mm_per_pixel = 1e-6;
  expect_refused(wrong, ErrorKind::kUsage, "mm_per_pixel");
  wrong = options();
  wrong.turn_deg = 400;
  expect_refused(wrong, ErrorKind::kUsage, "turn_deg");
  wrong = options();
  wrong.output = session_ / "raw";
  expect_refused(wrong, ErrorKind::kCannotCreate, "raw");
  wrong = options();
  wrong.session = work_ / "nothing.weft";
  expect_refused(wrong, ErrorKind::kNoInput, "nothing.weft");
  put_bytes(solved / "normal.exr", "no map");
  expect_refused(options(), ErrorKind::kBadData, "normal.exr");
}

TEST_F(Rectify, RefusesTheCalibrationOfAnotherFrameSizeOrWithoutCamera) {
  solve("fast");
  Result<Calibration> calibration = read_calibration(session_ / "calibration");
  ASSERT_TRUE(calibration);
  calibration->camera->size = {100, 80};
  ASSERT_TRUE(write_calibration(work_ / "other", *calibration));
  calibration->camera.reset();
  ASSERT_TRUE(write_calibration(work_ / "none", *calibration));
  RectifyOptions wrong = options();
  wrong.calibration = work_ / "other";
  const auto other = rectify_session(wrong, {});
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().message(), HasSubstr("48 x 32 pixels, its frames 100 x 80"));
  wrong.calibration = work_ / "none";
  const auto none = rectify_session(wrong, {});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message(), HasSubstr("camera"));
}

}  // namespace
}  // namespace weft::test
