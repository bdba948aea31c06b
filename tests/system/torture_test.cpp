// SPDX-License-Identifier: Apache-2.0
// testdata/scenes/torture.toml: every pixel that is hard to solve says why, and no other does.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/image_io/image_io.h"
#include "core/rig/light_field.h"
#include "core/solve/solve_record.h"
#include "solve/run/solve_session.h"
#include "solver/method.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

constexpr Size kTortureSize = {256, 192};
constexpr int kLineColumn = 252;  // where the plane of the LEDs meets the cloth

/// What the comments of the scene say of a pixel.
int expected_status(int x, int y) {
  const auto stripe = [&](int first) { return y >= first && y < first + 12; };
  const int ill = x == kLineColumn ? kIllConditioned : 0;
  if (stripe(24)) return kSaturated | ill;
  if (stripe(48)) return kSaturated | kNoSolution;
  if (stripe(72)) return kInvalidReading | ill;
  if (stripe(96) || stripe(120)) return kInvalidReading | kNoSolution;
  if (stripe(144)) return kDark | kNoSolution;
  return ill;
}

Image<float> map(const fs::path& file) {
  Result<LoadedImage> image = read_image(file);
  EXPECT_TRUE(image) << image.error().message();
  return image ? std::move(image->planes) : Image<float>();
}

TEST(Torture, HasTheStatusMapThatItsSceneDescribesByEveryMethod) {
  const Workspace work;
  simulate(scene_named("torture", kTortureSize), work / "torture.weft");
  for (const solver::MethodName& method : solver::method_names()) {
    if (method.extent == solver::Extent::kHalfSize) continue;
    SCOPED_TRACE(method.name);
    const fs::path maps = work / method.name;
    solve::SolveOptions options;
    options.method = method.name;
    options.output = maps;
    options.previews = false;
    const Result<solve::SolveReport> report =
        solve::solve_session({.folder = work / "torture.weft", .calibration = {}, .leds = {}}, options, {});
    ASSERT_TRUE(report) << report.error().message();
    const Image<float> status = map(maps / "status.png"), normal = map(maps / "normal.exr"),
                       truth = map(work / "torture.weft" / "truth" / "normal.exr");
    ASSERT_EQ(status.size(), kTortureSize);
    int wrong = 0;
    double worst_deg = 0;
    for (int y = 0; y < kTortureSize.height; ++y) {
      for (int x = 0; x < kTortureSize.width; ++x) {
        const int is = static_cast<int>(std::lround(65535.0 * status(x, y))), should = expected_status(x, y);
        if (is != should && wrong++ < 5)
          ADD_FAILURE() << "pixel " << x << ", " << y << ": status " << is << ", not " << should;
        const Vec3 n = {normal(x, y, 0), normal(x, y, 1), normal(x, y, 2)};
        ASSERT_NEAR(length(n), 1, 1e-6) << x << ", " << y;
        if ((should & kNoSolution) != 0) {
          ASSERT_EQ(n, (Vec3{0, 0, 1})) << x << ", " << y;
        } else if (x < 128) {  // where the condition number is below 7
          worst_deg = std::max(worst_deg, angle_deg(n, {truth(x, y, 0), truth(x, y, 1), truth(x, y, 2)}));
        }
      }
    }
    EXPECT_EQ(wrong, 0) << "pixels";
    EXPECT_LT(worst_deg, 1e-3) << "over twelve decades";
  }
}

TEST(Torture, IsMadeByOneVerbWithTheConditionOfTheLightsThatEachPixelKept) {
  const Workspace work;
  const Outcome run = run_weft({"torture", "-o", (work / "torture.weft").string(), "--json", "-q"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const std::string id = Json::parse(run.output)["id"];
  const fs::path maps = work / "torture.weft" / "solve" / id;
  const Image<float> decades = map(maps / "condition.exr"), status = map(maps / "status.png");
  ASSERT_EQ(decades.size(), kTortureSize);
  EXPECT_NEAR(decades(0, 0), std::log10(3), 0.05);
  EXPECT_NEAR(decades(kLineColumn - 1, 0), std::log10(1200), 0.05);
  for (int y = 0; y < kTortureSize.height; ++y) {
    for (int x = 0; x < kTortureSize.width; ++x) {
      const int flags = static_cast<int>(std::lround(65535.0 * status(x, y)));
      if ((flags & kNoSolution) == 0) {
        ASSERT_EQ(decades(x, y) >= std::log10(kIllConditionedFrom), (flags & kIllConditioned) != 0) << x << y;
      } else if ((flags & kDark) == 0) {
        ASSERT_EQ(decades(x, y), 16) << x << y << ": fewer than three lights are left";
      }
    }
  }
  const Outcome again = run_weft({"torture", "-o", (work / "torture.weft").string(), "--json", "-q"});
  EXPECT_EQ(again.output, run.output) << "what is there is not made again";
}

TEST(Torture, PrintsALineAHardCaseOfEachStage) {
  const Workspace work;
  const std::vector<std::string> arguments = {"torture", "-o", (work / "torture.weft").string(), "--strict",
                                              "-q"};
  const Outcome run = run_weft(arguments);
  ASSERT_EQ(run.exit_code, 0) << run.output;
  std::vector<std::string> with_json = arguments;
  with_json.emplace_back("--json");
  const Json document = run_weft(with_json).json();
  EXPECT_EQ(document["off"], 0) << document;
  EXPECT_GE(document["cases"].size(), 20U);
  for (const Json& hard : document["cases"]) {
    const std::string what = hard["what"];
    const auto at = run.output.find("\n  " + what + "  ");
    ASSERT_NE(at, std::string::npos) << what;
    const std::string line = run.output.substr(at + 1, run.output.find('\n', at + 1) - at - 1);
    EXPECT_NE(line.find(hard["unit"].get<std::string>()), std::string::npos) << line;
    EXPECT_NE(line.find(hard["flag"].get<std::string>()), std::string::npos) << line;
    EXPECT_EQ(line.find("no number") != std::string::npos, !hard.contains("plain")) << line;
    EXPECT_EQ(line.find("  -  ") != std::string::npos, !hard.contains("ours")) << line;
  }
}

TEST(Torture, IsExplainedPassByPass) {
  const Workspace work;
  put_bytes(work / "scene.toml", simulator::to_toml(scene_named("torture", {64, 48})));
  const Outcome run = run_weft({"simulate", (work / "scene.toml").string(), "-o",
                                (work / "explained.weft").string(), "--explain", "-q"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_NE(run.output.find("damage"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("left out              sigma at most"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("\nvignetting"), std::string::npos) << "unnamed, with its bound: " << run.output;
  EXPECT_NE(run.output.find("makes parts of frames missing, saturated, black or fade"), std::string::npos)
      << run.output;
}

}  // namespace
}  // namespace weft::test
