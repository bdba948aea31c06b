// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forecast.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "solver/method.h"
#include "tests/pipeline/cloth.h"

namespace weft::pipeline {
namespace {

constexpr double kAlbedo = 0.5;
// Mean over rms of an angle whose two components scatter alike.
const double kMeanOfRms = std::sqrt(kPi) / 2;

// Radians of rms angle of a level normal for readings off by one albedo: the lights' matrix is diagonal.
double angle_a_reading() {
  double xx = 0;
  for (const DistantLight& light : ten_lights().lights) xx += light.direction.x * light.direction.x;
  return std::sqrt(2 / xx);
}

// A level cloth, its readings off by `error` with the sign of every other light of the outer ring, which
// changes no normal and no albedo.
Forecast forecast_of(double sigma, double error = 0) {
  Photographs photographs = mosaics({128, 128}, {.albedo = {kAlbedo, kAlbedo, kAlbedo}});
  Mosaics& all = *photographs.mosaics();
  all.noise = {.per_reading = 0, .floor = sigma * sigma, .shared = 0};
  for (std::size_t k = 4; k < 10; ++k) {
    const int off = static_cast<int>(std::lround((k % 2 == 0 ? 1 : -1) * error * kRange));
    for (int y = 0; y < 128; ++y) {
      for (int x = 0; x < 128; ++x) {
        std::uint16_t& count = all.frames[k].counts(x, y);
        count = static_cast<std::uint16_t>(count + off);
      }
    }
  }
  const Result<Forecast> forecast = forecast_errors(photographs, 2);
  EXPECT_TRUE(forecast) << forecast.error().message();
  return *forecast;
}

TEST(Forecast, NamesTheLevelsInTheirOrder) {
  const Forecast forecast = forecast_of(1e-3);
  for (std::size_t i = 0; i < forecast.levels.size(); ++i) {
    EXPECT_EQ(forecast.levels[i].level, solver::method_names()[i].level) << i;
  }
}

TEST(Forecast, OfNoiseIsWhatTheLightsMakeOfIt) {
  const Forecast forecast = forecast_of(1e-3);
  const double expected_deg = kMeanOfRms * degrees(angle_a_reading() * 1e-3 / kAlbedo);
  for (const ErrorForecast& level : forecast.levels) {
    const double pixels = level.level == solver::Level::kPreview ? 4 : 1;
    const char* name = solver::method_of(level.level).name;
    EXPECT_NEAR(level.noise_deg * std::sqrt(pixels), expected_deg, 1e-3 * expected_deg) << name;
    EXPECT_LT(level.misfit_deg, 0.02 * expected_deg) << name;
    EXPECT_LT(level.indirect_deg, 1e-3) << name;
    EXPECT_LT(level.shortcut_deg, 0.02 * expected_deg) << name;
    EXPECT_EQ(level.calibration_deg, 0) << "nothing is known of it";
  }
}

TEST(Forecast, OfAMisfitIsTheAngleOfItsResidualWithoutTheNoise) {
  constexpr double kError = 0.004, kSigma = kError / 2;
  const Forecast forecast = forecast_of(kSigma, kError);
  const ErrorForecast& standard = forecast.levels[2];
  // Six readings of ten are off, and three of ten unknowns fit.
  const double spread = std::sqrt(0.6 * 10 / 7) * kError;
  const double expected_deg =
      kMeanOfRms * degrees(angle_a_reading() * std::sqrt(spread * spread - kSigma * kSigma) / kAlbedo);
  EXPECT_NEAR(standard.misfit_deg, expected_deg, 0.01 * expected_deg);
}

TEST(Forecast, TotalIsTheRootOfTheSquares) {
  const ErrorForecast parts = {.level = solver::Level::kFast,
                               .noise_deg = 1,
                               .misfit_deg = 2,
                               .indirect_deg = 4,
                               .shortcut_deg = 6,
                               .calibration_deg = 8};
  EXPECT_DOUBLE_EQ(parts.total_deg(), 11);
}

}  // namespace
}  // namespace weft::pipeline
