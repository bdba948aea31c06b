// SPDX-License-Identifier: Apache-2.0
#include "calibration/response/neutral_scale.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace weft::calibration {
namespace {

using testing::HasSubstr;

TEST(NeutralScale, HasTheReflectancesOfTheStandard) {
  EXPECT_NEAR(munsell_reflectance(10), 1, 1e-4);
  EXPECT_EQ(munsell_reflectance(0), 0);
  // Table of ASTM D1535: V 1 to 9.
  const std::array<double, 9> percent = {1.18, 3.05, 6.39, 11.7, 19.27, 29.3, 41.98, 57.6, 76.7};
  for (std::size_t i = 0; i < percent.size(); ++i) {
    EXPECT_NEAR(100 * munsell_reflectance(static_cast<double>(i + 1)), percent[i], 0.06) << "V " << i + 1;
  }
  EXPECT_EQ(munsell_scale().size(), 9U);
  EXPECT_NEAR(munsell_scale().front().reflectance, 0.878, 5e-4);
}

struct Scale {
  std::vector<double> reflectances;
  std::vector<std::array<double, 3>> v;

  explicit Scale(double shading, double bend) {
    for (const MunsellPatch& patch : munsell_scale()) reflectances.push_back(patch.reflectance);
    for (std::size_t i = 0; i < reflectances.size(); ++i) {
      const double light = 0.9 * reflectances[i] * std::exp(shading * (static_cast<double>(i) / 8 - 0.5));
      v.push_back(
          {0.5 * light * (1 + bend * light), light * (1 + bend * light), 0.7 * light * (1 + bend * light)});
    }
  }
};

TEST(NeutralScale, FindsWhiteAndLightThatFallsOffAlongIt) {
  const Scale scale(-0.2, 0);
  const auto check = check_scale(scale.reflectances, scale.v);
  ASSERT_TRUE(check) << check.error().message();
  EXPECT_NEAR(check->v_of_white[1], 0.9, 1e-9);
  EXPECT_NEAR(check->v_of_white[0], 0.45, 1e-9);
  EXPECT_NEAR(check->shading, std::expm1(-0.2), 1e-9);
  EXPECT_NEAR(check->rms_percent, 0, 1e-9);
}

// Light that falls off along the scale as a parabola looks much like a bend, since patches get darker along
// it: what is left is far below what a verdict is given for. A chart under LEDs at known places shows a bend
// (GreyChart.SeesABendOfTheResponse).
TEST(NeutralScale, TakesNearlyAllOfABentResponseForShading) {
  const std::array<std::array<double, 2>, 4> bends_and_rms_percent = {
      {{0.1, 0.16}, {0.3, 0.47}, {0.6, 0.88}, {1, 1.37}}};
  for (const auto& [bend, rms_percent] : bends_and_rms_percent) {
    const Scale scale(0, bend);
    const auto check = check_scale(scale.reflectances, scale.v);
    ASSERT_TRUE(check);
    std::printf("bent by %3.0f percent: %.2f percent rms is left\n", 100 * bend, check->rms_percent);
    EXPECT_NEAR(check->rms_percent, rms_percent, 0.02 * rms_percent + 0.005) << "bend " << bend;
  }
}

TEST(NeutralScale, SeesAPatchThatIsNotWhatItIsTakenFor) {
  Scale scale(-0.1, 0);
  for (double& v : scale.v[4]) v *= 1.1;
  const auto check = check_scale(scale.reflectances, scale.v);
  ASSERT_TRUE(check);
  EXPECT_GT(check->off_percent[4], 5);
  EXPECT_GT(check->rms_percent, 2);
}

TEST(NeutralScale, LeavesDarkPatchesOutAndSaysWhereTooFewAreLeft) {
  Scale scale(0, 0);
  for (std::size_t i = 0; i < 6; ++i) scale.v[i] = {0, 0, 0};
  const auto check = check_scale(scale.reflectances, scale.v);
  ASSERT_FALSE(check);
  EXPECT_THAT(check.error().message(), HasSubstr("3 of its patches"));
  scale.v.pop_back();
  EXPECT_FALSE(check_scale(scale.reflectances, scale.v));
}

}  // namespace
}  // namespace weft::calibration
