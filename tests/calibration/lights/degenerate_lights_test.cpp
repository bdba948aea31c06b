// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bench/oracles/paper_oracle.h"
#include "calibration/lights/physical.h"

// Captures that can hardly say what they are asked: which of them are solved, with a sigma that tells the
// truth, and which are refused.

namespace weft::calibration {
namespace {

using test::PaperErrors;
using test::PaperRig;

Result<LightFit> fit_of(const PaperRig& rig, std::uint64_t seed) {
  PaperErrors errors;
  errors.seed = seed;
  errors.noise = 0.002 / std::sqrt(11.0);
  const auto captures = test::captures_of(rig, errors, 8, 5);
  return fit_lights(captures.start, captures.readings, {});
}

// The fit is accepted, is or is not called weak, and is within its own sigma: over all LEDs and axes, root
// mean square below 1.5, and nowhere beyond 4.
enum class Known { kWeakly, kWell };
void expect_solved(const PaperRig& rig, std::uint64_t seed, Known known) {
  const Result<LightFit> fit = fit_of(rig, seed);
  ASSERT_TRUE(fit) << fit.error().message() << ", seed " << seed;
  ASSERT_FALSE(fit->misfits()) << "chi-square " << fit->chi_square << ", seed " << seed;
  EXPECT_EQ(fit->is_weak(), known == Known::kWeakly)
      << "worst sigma " << fit->worst_position_sigma_mm() << " mm, seed " << seed;
  double sum = 0, worst = 0;
  for (std::size_t k = 0; k < rig.lights.leds.size(); ++k) {
    const Vec3 off = fit->scene.lights.leds[k].position_mm - rig.lights.leds[k].position_mm;
    const Vec3 sigma = fit->position_sigma_mm[k];
    for (const double normalised : {off.x / sigma.x, off.y / sigma.y, off.z / sigma.z}) {
      sum += normalised * normalised;
      worst = std::max(worst, std::abs(normalised));
    }
  }
  EXPECT_LT(std::sqrt(sum / (3.0 * static_cast<double>(rig.lights.leds.size()))), 1.5)
      << "worst " << worst << " sigma, chi-square " << fit->chi_square << ", seed " << seed;
  EXPECT_LT(worst, 4) << "chi-square " << fit->chi_square << ", seed " << seed;
}

TEST(DegenerateLights, OneFlatSheetIsSolvedWeakly) {
  PaperRig rig = test::common_rig();
  rig.sheets = test::lies(1);
  for (const std::uint64_t seed : {1u, 2u, 3u}) expect_solved(rig, seed, Known::kWeakly);
}

TEST(DegenerateLights, FiveTimesTheSamePoseAreSolvedWeakly) {
  PaperRig rig = test::common_rig();
  rig.sheets.assign(5, {});
  for (const std::uint64_t seed : {1u, 2u}) expect_solved(rig, seed, Known::kWeakly);
}

TEST(DegenerateLights, TiltsUnderTwoDegreesAreSolvedWeakly) {
  PaperRig rig = test::common_rig();
  rig.sheets = test::lies(5, 1.5);
  for (const std::uint64_t seed : {1u, 2u}) expect_solved(rig, seed, Known::kWeakly);
}

TEST(DegenerateLights, ASheetSeenEdgeOnIsRefused) {
  PaperRig rig = test::common_rig();
  rig.sheets.back().tilt_deg = 84;
  for (const std::uint64_t seed : {1u, 2u}) {
    const Result<LightFit> fit = fit_of(rig, seed);
    ASSERT_FALSE(fit) << "chi-square " << fit->chi_square << ", seed " << seed;
    EXPECT_THAT(fit.error().message(), testing::HasSubstr("leave out blocks that are not lit"))
        << "seed " << seed;
  }
}

TEST(DegenerateLights, ALedOnTheOpticalAxisIsSolvedWell) {
  PaperRig rig = test::common_rig();
  rig.lights.leds[0].position_mm = {0, 0, 590};
  rig.lights.leds[0].aim = {0, 0, -1};
  for (const std::uint64_t seed : {1u, 2u}) expect_solved(rig, seed, Known::kWell);
}

TEST(DegenerateLights, OneFlatSheetOfPaperThatIsNotLambertianIsSolvedWeakly) {
  PaperRig rig = test::common_rig();
  rig.sheets = test::lies(1);
  rig.delta = 0.05;
  for (const std::uint64_t seed : {1u, 2u}) expect_solved(rig, seed, Known::kWeakly);
}

}  // namespace
}  // namespace weft::calibration
