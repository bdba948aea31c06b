// SPDX-License-Identifier: Apache-2.0
// What the levels promise each other, on whole sessions.
#include <gtest/gtest.h>

#include "core/image_io/image_io.h"
#include "material/read/compare.h"
#include "solve/run/solve_session.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

constexpr Size kSize = {192, 128};

class Levels : public testing::Test {
 protected:
  solve::SolveReport solve(const std::string& level, int threads = 2) {
    solve::SolveOptions options;
    options.method = level;
    options.output = work_ / level;
    options.previews = false;
    Result<solve::SolveReport> report = solve::solve_session(
        {.folder = session_, .calibration = {}, .leds = {}}, options, {.threads = threads});
    EXPECT_TRUE(report) << report.error().message();
    return std::move(*report);
  }
  double error_deg(const std::string& level) {
    const auto compared =
        material::compare_normals(work_ / level / "normal.exr", session_ / "truth" / "normal.exr", {});
    EXPECT_TRUE(compared) << compared.error().message();
    return compared->mean_deg;
  }

  Workspace work_;
  const fs::path session_ = work_ / "cloth.weft";
};

TEST_F(Levels, ReferenceHalvesTheErrorOfADeepWeave) {
  simulate(scene_named("deep", kSize), session_);
  const solve::SolveReport report = solve("reference");
  solve("standard");
  EXPECT_LT(error_deg("reference"), 0.5 * error_deg("standard"))
      << error_deg("standard") << " degrees by standard";
  EXPECT_EQ(report.facts.reference->stages, (std::vector<std::string>{"shadows", "interreflection"}));
  EXPECT_EQ(report.facts.pixels, kSize.pixels());
}

TEST_F(Levels, ReferenceIsTheSameForAnyThreads) {
  simulate(scene_named("deep", {130, 70}), session_);
  solve("reference", 1);
  const std::string alone = bytes_of(work_ / "reference" / "normal.exr");
  fs::remove_all(work_ / "reference");
  solve("reference", 3);
  EXPECT_TRUE(bytes_of(work_ / "reference" / "normal.exr") == alone);
}

TEST_F(Levels, ReferenceRunsNoStageOnAFlatCardAndSaysWhy) {
  simulate(scene_named("flat", kSize), session_);
  const solve::SolveReport report = solve("reference");
  EXPECT_TRUE(report.facts.reference->stages.empty());
  EXPECT_TRUE(report.facts.reference->rounds.empty());
  ASSERT_EQ(report.facts.gates.size(), 4U);
  for (const GateFacts& gate : report.facts.gates) EXPECT_FALSE(gate.is_over) << gate.name << gate.value;
  EXPECT_EQ(report.facts.solved_by->float32, kSize.pixels());
}

TEST_F(Levels, PreviewIsHalfTheSizeAndRightOnACard) {
  simulate(scene_named("flat", kSize), session_);
  const solve::SolveReport report = solve("preview");
  EXPECT_EQ(report.facts.size, (Size{kSize.width / 2, kSize.height / 2}));
  const auto normal = read_image(work_ / "preview" / "normal.exr");
  ASSERT_TRUE(normal) << normal.error().message();
  EXPECT_NEAR(normal->planes(kSize.width / 4, kSize.height / 4, 2), 1, 1e-5);
}

TEST_F(Levels, StandardCountsHowItsPixelsWereSolved) {
  simulate(scene_named("twill", kSize), session_);
  const std::optional<SolvedBy> solved = solve("standard").facts.solved_by;
  ASSERT_TRUE(solved);
  EXPECT_EQ(solved->float32 + solved->in_double + solved->qr + solved->svd + solved->unsolved,
            kSize.pixels());
}

}  // namespace
}  // namespace weft::test
