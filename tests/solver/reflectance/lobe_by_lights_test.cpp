// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/lobe_by_lights.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "solver/reflectance/measured_lobe.h"
#include "tests/solver/reflectance/lights_off.h"

namespace weft::solver {
namespace {

constexpr std::size_t kFew = 300;
const Lobe kSteel = {.family = LobeFamily::kGgx, .alpha = 0.25, .f0 = 0.05};

LobeFit fitted_to(const PixelTruth& cloth) {
  const LobeFit start = {kSteel, cloth.b, cloth.yarn, {}, 0};
  return fit_lobe(cloth.samples, start, {.fitted = parameters_of(kSteel.family), .rounds = 20, .threads = 1});
}

double sigma_of(const LobeByLights& by_lights, LobeParameter parameter, const std::vector<double>& errors) {
  const auto i = static_cast<std::size_t>(parameter);
  return std::sqrt(by_lights.covariance_of(errors)[i][i]);
}

// What a fit makes of lights that are wrong by so little is the truth.
TEST(LobeByLights, IsWhatAFitMakesOfLightsThatAreWrong) {
  const std::array<Vec3, 4> turns = {Vec3{}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  std::vector<LightError> errors(10);
  const PixelTruth right = pixels_off(kSteel, kFew, {.noise = 0}, errors, 1);
  const LobeFit before = fitted_to(right);
  const LobeByLights by_lights(right.samples, before, parameters_of(kSteel.family));
  ASSERT_EQ(by_lights.errors(), 40U);
  constexpr double kWrong = 0.003;
  for (const std::size_t light : {1U, 6U}) {
    for (std::size_t e = 0; e < LobeByLights::kErrors; ++e) {
      errors[light] = {e == 0 ? kWrong : 0, kWrong * turns[e]};
      const Lobe after = fitted_to(pixels_off(kSteel, kFew, {.noise = 0}, errors, 1)).lobe;
      errors[light] = {};
      const double alpha = std::log(after.alpha / before.lobe.alpha) / kWrong,
                   f0 = (after.f0 - before.lobe.f0) / kWrong;
      EXPECT_NEAR(by_lights.change_of(LobeParameter::kLogAlpha)[4 * light + e], alpha,
                  0.1 * std::abs(alpha) + 0.02)
          << "light " << light << " error " << e;
      EXPECT_NEAR(by_lights.change_of(LobeParameter::kF0)[4 * light + e], f0, 0.1 * std::abs(f0) + 0.001)
          << "light " << light << " error " << e;
    }
  }
}

TEST(LobeByLights, MakesSigmaOfACovariance) {
  const PixelTruth cloth = pixels_off(kSteel, kFew, {}, std::vector<LightError>(10), 2);
  const LobeByLights by_lights(cloth.samples, fitted_to(cloth), parameters_of(kSteel.family));
  double variance = 0;
  const auto change = by_lights.change_of(LobeParameter::kF0);
  for (std::size_t i = 0; i < 40; i += 4) variance += std::pow(0.01 * change[i], 2);
  const double independent = sigma_of(by_lights, LobeParameter::kF0, covariance_of_lights(0.01, 0));
  EXPECT_NEAR(independent, std::sqrt(variance), 1e-12);
  EXPECT_GT(independent, 0);
  // Parameters that are not fitted do not move.
  EXPECT_EQ(sigma_of(by_lights, LobeParameter::kAxis, covariance_of_lights(0.01, 0.01)), 0);
}

TEST(LobeByLights, WidensTheSigmasOfAMeasuredLobe) {
  const PixelTruth cloth = pixels_off(kSteel, 320, {}, std::vector<LightError>(10), 3);
  MeasuredLobe found = measure_lobe(cloth.samples, cloth.start, 0);
  ASSERT_TRUE(found.is_measured()) << name_of(found.refusal);
  EXPECT_GE(found.sigma_f0,
            sigma_of(found.by_lights, LobeParameter::kF0, covariance_of_lights(kLightDrift, 0)));
  const double alpha = found.sigma_alpha, f0 = found.sigma_f0;
  const auto covariance = covariance_of_lights(0.01, 0.003);
  add_light_errors(covariance, found);
  EXPECT_NEAR(found.sigma_alpha,
              std::hypot(alpha, sigma_of(found.by_lights, LobeParameter::kLogAlpha, covariance)), 1e-12);
  EXPECT_NEAR(found.sigma_f0, std::hypot(f0, sigma_of(found.by_lights, LobeParameter::kF0, covariance)),
              1e-12);
  EXPECT_GT(found.sigma_f0, f0);
}

}  // namespace
}  // namespace weft::solver
