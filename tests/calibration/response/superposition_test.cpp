// SPDX-License-Identifier: Apache-2.0
#include "calibration/response/superposition.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "bench/oracles/virtual_sensor.h"

namespace weft::calibration {
namespace {

using test::VirtualSensor;
using testing::HasSubstr;

constexpr Size kSumFrame = {160, 128};

// Two LEDs over a scene of stripes, by themselves and together, at several exposures.
struct SuperposedCapture {
  VirtualSensor sensor = VirtualSensor::of(simulator::Body::kOffset);
  double drift = 0;    // the first LED is brighter by this beside the second
  double ambient = 0;  // of full scale at the longest exposure
  std::deque<BlockLight> lights = {};
  std::deque<std::array<double, 3>> darks = {};
  std::vector<SuperposedLight> superposed = {};

  void take(bool knows_dark) {
    int take = 0;
    for (const double exposure : {0.06, 0.2, 0.5, 0.9, 1.7, 3.4}) {
      const auto light = [&](double first, double second) {
        return [=, this](int x, int y, int c) {
          const double albedo = (y / 32) % 2 != 0 ? 0.9 : 0.3;
          const double shade = 0.7 + 0.3 * x / kSumFrame.width;
          const double channel = c == 1 ? 1.0 : c == 0 ? 0.5 : 0.68;
          return exposure * (0.5 * channel * albedo * (first * shade + second * (1.7 - shade)) + ambient);
        };
      };
      const auto mean = [&](double first, double second) {
        BlockLight& sum = lights.emplace_back();
        for (int i = 0; i < 2; ++i) {
          join(sum, block_light(sensor.frame(kSumFrame, take++, 1000, light(first, second)), {}));
        }
        return &sum;
      };
      darks.push_back(mean(0, 0)->mean);
      const auto* first = mean(1, 0);
      const auto* second = mean(0, 1);
      const auto* both = mean(1 + drift, 1);
      superposed.push_back({first, second, both, knows_dark ? &darks.back() : nullptr});
    }
  }

  SuperpositionNoise noise() const {
    const double full = sensor.sensor.white - sensor.sensor.black;
    const Response truth = response_of(sensor.sensor);
    return {truth.electrons_per_count * full, truth.read_noise_counts / full, 0.0005};
  }
};

TEST(Superposition, FindsABendOfHalfAPercentAndItsSigma) {
  for (const bool knows_dark : {true, false}) {
    SuperposedCapture capture;
    capture.sensor.linearity = {0.02, 0.01};
    capture.ambient = knows_dark ? 0.001 : 0;
    capture.take(knows_dark);
    const auto fit = fit_superposition(capture.superposed, capture.noise());
    ASSERT_TRUE(fit) << fit.error().message();
    const double truth = departure_from_line(capture.sensor.linearity);
    EXPECT_GT(truth, 0.005);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(fit->departure(c), truth, 0.001) << "channel " << c << ", dark known " << knows_dark;
      EXPECT_LT(fit->sigma_departure(c), 0.001);
      EXPECT_GT(fit->highest_v[c], 0.6);
      const auto off = departure_from_line({fit->linearity[c][0] - 0.02, fit->linearity[c][1] - 0.01});
      EXPECT_LT(off, 0.001) << "what the correction leaves";
    }
    EXPECT_NEAR(fit->chi_square_per_freedom, 1, 0.15);
  }
}

TEST(Superposition, FindsTheBlackLevelWithoutADarkFrame) {
  for (const double wrong_counts : {0.0, 12.0}) {
    SuperposedCapture capture;
    capture.sensor = VirtualSensor::of(simulator::Body::kD5100);
    capture.take(false);
    for (BlockLight& light : capture.lights) {
      for (auto& block : light.blocks) {
        for (Moments& m : block) m = shifted(m, -wrong_counts / capture.sensor.sensor.white);
      }
    }
    const auto fit = fit_superposition(capture.superposed, capture.noise());
    ASSERT_TRUE(fit) << fit.error().message();
    EXPECT_NEAR(fit->offset * capture.sensor.sensor.white, wrong_counts, 0.3);
    EXPECT_LT(fit->sigma_offset, 1e-5);
  }
}

TEST(Superposition, IsNotMisledByALedThatIsBrighterTheSecondTime) {
  SuperposedCapture capture;
  capture.drift = 0.002;
  capture.take(true);
  SuperpositionNoise noise = capture.noise();
  noise.drift = 0.002;
  const auto steady = fit_superposition(capture.superposed, noise);
  ASSERT_TRUE(steady);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_LT(steady->departure(c), 0.001) << "channel " << c;
  noise.drift = 1e-6;
  const auto misled = fit_superposition(capture.superposed, noise);
  ASSERT_TRUE(misled);
  EXPECT_GT(misled->chi_square_per_freedom, 1.3) << "and where drift is not allowed for, the fit says so";
}

TEST(Superposition, SeesThatOneOfTheTwoDidNotLight) {
  SuperposedCapture capture;
  capture.take(true);
  EXPECT_NEAR(sum_over_both(capture.superposed[1]), 1, 0.01);
  SuperposedLight broken = capture.superposed[1];
  broken.both = broken.first;
  EXPECT_NEAR(sum_over_both(broken), 2, 0.05);
}

TEST(Superposition, RefusesPairsThatAreFull) {
  SuperposedCapture capture;
  capture.take(true);
  for (BlockLight& light : capture.lights) {
    for (auto& block : light.blocks) block = {};
  }
  const auto fit = fit_superposition(capture.superposed, capture.noise());
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message(), HasSubstr("shorter exposures"));
}

TEST(Departure, IsThatOfTheBestLineThroughNothing) {
  EXPECT_NEAR(departure_from_line({0, 0}), 0, 1e-12);
  // a (v^2 - s v) is as far off at v = s / 2 as at 1 where s = 2 (sqrt 2 - 1): a (3 - 2 sqrt 2).
  EXPECT_NEAR(departure_from_line({0.1, 0}), 0.1 * (3 - 2 * std::sqrt(2.0)), 1e-5);
  EXPECT_NEAR(departure_from_line({-0.1, 0}), departure_from_line({0.1, 0}), 1e-9);
}

}  // namespace
}  // namespace weft::calibration
