// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/grey_chart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bench/oracles/grey_oracle.h"
#include "calibration/lights/physical.h"

namespace weft::calibration {
namespace {

using test::GreyCapture;
using test::GreyErrors;
using test::PaperRig;
using testing::HasSubstr;

constexpr GreyErrors kNone = {0, 0, 0, 0, 0, 0, 0, 1};

PaperRig rig_of_test() {
  PaperRig rig = test::common_rig();
  rig.vignette = 0;
  test::give_gains(rig.lights, 0.01);
  return rig;
}

// LEDs whose places are known and whose brightness is not.
NearLights dimmed(NearLights lights) {
  for (NearLight& led : lights.leds) led.flux_rgb = {1, 1, 1};
  return lights;
}

CameraModel camera_of(const PaperRig& rig) {
  return test::captures_of(rig, {}, 1, 1).start.camera;
}

GreyChartFit fitted(const PaperRig& rig, const NearLights& lights, const GreyErrors& errors,
                    const GreyChartOptions& options = {}) {
  const GreyCapture capture = test::greys_of(rig, errors);
  Result<GreyChartFit> fit =
      fit_grey_chart(camera_of(rig), lights, capture.patches, capture.full_reading, options);
  EXPECT_TRUE(fit) << fit.error().message();
  return fit ? std::move(*fit) : GreyChartFit();
}

/// Mean squares of errors over their sigma.
struct Score {
  double flux = 0, balance = 0, bend = 0, chi_square = 0;
};
Score score_of(const GreyChartFit& fit, const NearLights& truth) {
  Score score;
  const double leds = static_cast<double>(truth.leds.size());
  for (std::size_t k = 0; k < truth.leds.size(); ++k) {
    std::array<double, 3> off = {};
    for (std::size_t c = 0; c < 3; ++c) {
      off[c] = std::log(fit.lights.leds[k].flux_rgb[c] / truth.leds[k].flux_rgb[c]);
      score.flux += std::pow(off[c] / fit.flux_sigma[k][c], 2) / (3 * leds);
    }
    score.balance += (std::pow((off[0] - off[1]) / fit.balance_sigma[k][0], 2) +
                      std::pow((off[2] - off[1]) / fit.balance_sigma[k][1], 2)) /
                     (2 * leds);
  }
  score.bend = std::pow(fit.bend / fit.bend_sigma, 2);
  score.chi_square = fit.chi_square;
  return score;
}

TEST(GreyChart, TellsFluxesExactlyWhereNothingIsWrong) {
  const PaperRig rig = rig_of_test();
  const GreyChartFit fit = fitted(rig, dimmed(rig.lights), kNone);
  for (std::size_t k = 0; k < rig.lights.leds.size(); ++k) {
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(fit.lights.leds[k].flux_rgb[c] / rig.lights.leds[k].flux_rgb[c], 1, 1e-6)
          << "LED " << k + 1;
  }
  EXPECT_NEAR(fit.bend, 0, 1e-6);
  EXPECT_LT(fit.chi_square, 1e-4);
}

TEST(GreyChart, ErrsAsTheCramerRaoBoundSays) {
  const PaperRig rig = rig_of_test();
  constexpr int kSeeds = 200;
  Score mean;
  double flux_sigma = 0, balance_sigma = 0, bend_sigma = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    GreyErrors errors;
    errors.seed = static_cast<std::uint64_t>(seed);
    const GreyChartFit fit = fitted(rig, dimmed(rig.lights), errors);
    const Score score = score_of(fit, rig.lights);
    mean.flux += score.flux / kSeeds;
    mean.balance += score.balance / kSeeds;
    mean.bend += score.bend / kSeeds;
    mean.chi_square += score.chi_square / kSeeds;
    flux_sigma = fit.flux_sigma[0][1], balance_sigma = fit.balance_sigma[0][0], bend_sigma = fit.bend_sigma;
  }
  std::printf("error over sigma, rms: flux %.3f, balance %.3f, bend %.3f; sigma %.3f, %.3f, %.2f percent\n",
              std::sqrt(mean.flux), std::sqrt(mean.balance), std::sqrt(mean.bend), 100 * flux_sigma,
              100 * balance_sigma, 100 * bend_sigma);
  EXPECT_NEAR(std::sqrt(mean.flux), 1, 0.15);
  EXPECT_NEAR(std::sqrt(mean.balance), 1, 0.1);
  EXPECT_NEAR(std::sqrt(mean.bend), 1, 0.15);
  EXPECT_NEAR(mean.chi_square, 1, 0.1);
}

// Places and fluxes by five poses of white paper, fluxes once more by the chart under LEDs at those places:
// two measurements of one thing.
TEST(GreyChart, AgreesWithWhitePaperWithinTheirSigma) {
  const PaperRig rig = test::common_rig();
  const test::PaperCaptures paper = test::captures_of(rig, {}, 13, 8);
  const Result<LightFit> by_paper = fit_lights(paper.start, paper.readings, {});
  ASSERT_TRUE(by_paper) << by_paper.error().message();
  double flux = 0, balance = 0;
  constexpr int kSeeds = 20;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    GreyErrors errors;
    errors.seed = static_cast<std::uint64_t>(seed);
    const GreyChartFit by_chart = fitted(rig, by_paper->scene.lights, errors);
    const Score score = score_of(by_chart, by_paper->scene.lights);
    flux += score.flux / kSeeds;
    balance += score.balance / kSeeds;
  }
  EXPECT_GT(std::sqrt(flux), 0.5);
  EXPECT_LT(std::sqrt(flux), 1.3);
  EXPECT_LT(std::sqrt(balance), 1.3);
}

TEST(GreyChart, SeesABendOfTheResponse) {
  const PaperRig rig = rig_of_test();
  for (const double bend : {0.0, 0.1, 0.3, 0.6, 1.0}) {
    GreyErrors errors;
    errors.bend = bend;
    const GreyChartFit fit = fitted(rig, dimmed(rig.lights), errors);
    std::printf("bent by %3.0f percent: %.1f +- %.1f percent to be added\n", 100 * bend, -100 * fit.bend,
                100 * fit.bend_sigma);
    if (bend == 0) {
      EXPECT_LT(std::abs(fit.bend), 3 * fit.bend_sigma);
    } else {
      EXPECT_LT(fit.bend, -4 * fit.bend_sigma) << "bent by " << 100 * bend << " percent";
    }
  }
}

TEST(GreyChart, LeavesOutWhatIsFullAndNamesALedThatIsNotSeen) {
  const PaperRig rig = rig_of_test();
  GreyCapture capture = test::greys_of(rig, kNone);
  capture.patches[0].reading_rgb[4].fill(std::numeric_limits<double>::infinity());
  const auto without = fit_grey_chart(camera_of(rig), rig.lights, capture.patches, capture.full_reading);
  ASSERT_TRUE(without) << without.error().message();
  EXPECT_NEAR(without->lights.leds[4].flux_rgb[1] / rig.lights.leds[4].flux_rgb[1], 1, 1e-6);

  for (std::size_t p = 0; p < 7; ++p)
    capture.patches[p].reading_rgb[4].fill(std::numeric_limits<double>::quiet_NaN());
  const auto unlit = fit_grey_chart(camera_of(rig), rig.lights, capture.patches, capture.full_reading);
  ASSERT_FALSE(unlit);
  EXPECT_THAT(unlit.error().message(), HasSubstr("LED 5"));
  EXPECT_THAT(unlit.error().message(), HasSubstr("2 of 9"));

  capture.patches[0].reflectance = 0;
  const auto black = fit_grey_chart(camera_of(rig), rig.lights, capture.patches, capture.full_reading);
  ASSERT_FALSE(black);
  EXPECT_EQ(black.error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace weft::calibration
