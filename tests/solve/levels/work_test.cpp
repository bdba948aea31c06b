// SPDX-License-Identifier: Apache-2.0
#include "solve/levels/work.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "solve/levels/frame.h"
#include "solver/reflectance/lobe.h"
#include "tests/solve/cloth.h"

namespace weft::solve {
namespace {

TEST(SolveWork, OnALargerFrameGrowsByWhatEachPartGoesBy) {
  const SolveWork cut = {.frame = 2, .few_rows = 1, .choice = 4, .samples = 0.5, .lobe = 3};
  const SolveWork frame = carried_over(cut, {512, 256}, {4096, 2048});
  EXPECT_DOUBLE_EQ(frame.frame, 2 * 64) << "by pixels";
  // Half of the cells of 64 x 64 choose: of one row of blocks there, of four here.
  EXPECT_DOUBLE_EQ(frame.few_rows, 4 * 8);
  EXPECT_DOUBLE_EQ(frame.choice, 4.0 * 512 / 256) << "a small frame takes more rows of its cells";
  EXPECT_DOUBLE_EQ(frame.samples, 0.5 * 16 / 8) << "sixteen tiles in place of eight";
  EXPECT_DOUBLE_EQ(frame.lobe, 3) << "as many pixels of any frame are fitted";
  EXPECT_DOUBLE_EQ(frame.total(), 128 + 32 + 8 + 1 + 3);
}

TEST(SolveWork, OnTheFrameThatItWasMeasuredOnIsItself) {
  const SolveWork work = {.frame = 2, .few_rows = 1, .choice = 4, .samples = 0.5, .lobe = 3};
  for (const Size size : {Size{16, 8}, Size{64, 64}, Size{1000, 700}})
    EXPECT_DOUBLE_EQ(carried_over(work, size, size).total(), 10.5) << size.width;
}

TEST(SolveWork, OfTheRobustLevelTellsTheSearchForALobeApart) {
  const Size size = {256, 128};
  const Photographs photographs =
      mosaics(size, {.normal = wave,
                     .albedo = {0.1, 0.1, 0.1},
                     .lobe = {.family = solver::LobeFamily::kGgx, .alpha = 0.35, .f0 = 0.05}});
  WholeMaps maps(size);
  Stopwatch watch;
  const auto facts =
      solve_frame(photographs, *solver::find_method("robust"), kSolveTile, {.threads = 1}, std::ref(maps));
  const double seconds = watch.lap();
  ASSERT_TRUE(facts) << facts.error().message();
  EXPECT_GT(facts->work.lobe, 0);
  EXPECT_DOUBLE_EQ(facts->work.lobe, facts->gloss->seconds);
  EXPECT_GT(facts->work.frame, 0);
  EXPECT_LE(facts->work.total() + facts->waited_seconds, seconds) << "no second is counted twice";
  EXPECT_EQ(facts->work.few_rows + facts->work.choice + facts->work.samples, 0) << "of the level reference";
}

}  // namespace
}  // namespace weft::solve
