// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "tests/solver/reflectance/tinted_pixels.h"

namespace weft::solver {
namespace {

TEST(LobeTintSoak, IsFoundInNoneOfTwoHundredClothsWhoseHighlightsAreWhite) {
  const WhiteTrials trials = white_trials(200, 1000);
  fmt::print("{} measured, {} with a tint, the farthest ratio {:.2f} sigma off\n", trials.measured,
             trials.called, trials.farthest);
  EXPECT_GE(trials.measured, 190);
  EXPECT_EQ(trials.called + trials.changed, 0);
}

TEST(LobeTintSoak, IsWithinThreeSigmaInNinetyEightOfAHundredCloths) {
  const GoldenTrials trials = golden_trials(100, 1000);
  fmt::print("{} of 100 found, {} of {} f0 beyond 3 sigma, rms over sigma {:.2f}\n", trials.found,
             trials.beyond, 3 * trials.found, trials.rms);
  EXPECT_GE(trials.found, 98);
  EXPECT_LE(trials.beyond, 0.02 * 3 * trials.found);
  EXPECT_GT(trials.rms, 0.2);
}

}  // namespace
}  // namespace weft::solver
