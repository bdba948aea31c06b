// SPDX-License-Identifier: Apache-2.0
// The stored session and its maps; testdata/golden/README.md says how they were made.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "core/image_io/image_io.h"
#include "material/read/compare.h"
#include "solve/run/solve_session.h"
#include "tests/simd_targets.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

const fs::path kGolden = source_file("testdata/golden");
const fs::path kSession = kGolden / "twill.weft";
const fs::path kExpected = kGolden / "expected";

/// The largest difference of two albedo maps, in units of the rounding to a half float.
double largest_half_steps(const fs::path& tested, const fs::path& truth) {
  const Result<LoadedImage> a = read_image(tested), b = read_image(truth);
  if (!a || !b || a->info.size != b->info.size) {
    ADD_FAILURE() << "no two maps of one size: " << tested << ", " << truth;
    return 0;
  }
  double largest = 0;
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < a->info.size.height; ++y) {
      for (int x = 0; x < a->info.size.width; ++x) {
        const double expected = b->planes(x, y, c);
        const double step =
            std::exp2(std::max(std::floor(std::log2(std::abs(expected) + 1e-30)), -14.0) - 10);
        largest = std::max(largest, std::abs(a->planes(x, y, c) - expected) / step);
      }
    }
  }
  return largest;
}

/// Counts pixels where two maps of one channel differ, whatever else their files say; -1 where they cannot be
/// compared.
int differing_pixels(const fs::path& tested, const fs::path& truth) {
  const Result<LoadedImage> a = read_image(tested), b = read_image(truth);
  if (!a || !b || a->info.size != b->info.size) return -1;
  int differing = 0;
  for (int y = 0; y < a->info.size.height; ++y) {
    for (int x = 0; x < a->info.size.width; ++x) differing += a->planes(x, y) != b->planes(x, y);
  }
  return differing;
}

void expect_golden_maps(const fs::path& maps) {
  const Result<solve::NormalComparison> normal =
      material::compare_normals(maps / "normal.exr", kExpected / "normal.exr", {});
  ASSERT_TRUE(normal) << normal.error().message();
  EXPECT_EQ(normal->pixels, 256 * 256);
  EXPECT_LT(normal->max_deg, 0.005);
  EXPECT_LE(largest_half_steps(maps / "albedo.exr", kExpected / "albedo.exr"), 1.001);
  EXPECT_EQ(differing_pixels(maps / "status.png", kExpected / "status.png"), 0);
}

TEST(Golden, TheStoredSessionSolvesToTheStoredMaps) {
  const Workspace work;
  const auto before = contents_of(kGolden);
  const Outcome run =
      run_weft({"solve", kSession.string(), "--quality", "fast", "-o", (work / "maps").string(), "-q"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  expect_golden_maps(work / "maps");
  EXPECT_EQ(contents_of(kGolden), before);
}

TEST(Golden, EverySimdTargetOfThisMachineSolvesToTheStoredMaps) {
  on_every_target([] {
    const Workspace work;
    solve::SolveOptions options;
    options.method = "fast";
    options.output = work / "maps";
    options.previews = false;
    const Result<solve::SolveReport> report =
        solve::solve_session({.folder = kSession, .calibration = {}, .leds = {}}, options, {});
    ASSERT_TRUE(report) << report.error().message();
    expect_golden_maps(work / "maps");
  });
}

TEST(Golden, AScanOfAnEarlierVersionIsSolvedAndItsSolveOfThenRectified) {
  const Workspace work;
  const fs::path scan = kGolden / "satin.weft";
  const auto before = contents_of(scan);
  const Outcome solved =
      run_weft({"solve", scan.string(), "--quality", "fast", "-o", (work / "maps").string(), "-q"});
  EXPECT_EQ(solved.exit_code, 0) << solved.error;
  const Outcome rectified = run_weft({"rectify", scan.string(), "--solve", "7cf91e8f08f74f49",
                                      "--mm-per-pixel", "12", "-o", (work / "rectified").string(), "-q"});
  ASSERT_EQ(rectified.exit_code, 0) << rectified.error;
  EXPECT_EQ(differing_pixels(work / "rectified" / "status.png",
                             scan / "rectified" / "409d289d795aa39e" / "status.png"),
            0);
  EXPECT_EQ(contents_of(scan), before);
}

TEST(Golden, TheSceneSimulatesToTheStoredSession) {
  const Workspace work;
  const Outcome run = run_weft({"simulate", source_file("testdata/scenes/golden.toml").string(), "-o",
                                (work / "twill.weft").string(), "-q"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  fs::remove_all(work / "twill.weft" / "truth");  // not stored
  EXPECT_EQ(contents_of(work / "twill.weft"), contents_of(kSession));
}

}  // namespace
}  // namespace weft::test
