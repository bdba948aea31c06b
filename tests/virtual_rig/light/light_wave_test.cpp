// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/light/light_wave.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <complex>

#include "core/base/vec.h"

namespace weft::virtual_rig {
namespace {

const LightWave kLamp = {100, 0.3, {}};
const LightWave kPulses = {500, 0.8, 0.25};

/// Its mean by many readings.
double sampled(const LightWave& wave, double from_s, double length_s) {
  constexpr int kReadings = 200000;
  double sum = 0;
  for (int i = 0; i < kReadings; ++i) {
    const double turns = wave.hertz * (from_s + (i + 0.5) / kReadings * length_s);
    const double part = turns - std::floor(turns);
    const double all = wave.duty ? 1 - wave.depth * (1 - *wave.duty) : 1;
    sum += !wave.duty          ? 1 + wave.depth * std::sin(2 * kPi * part)
           : part < *wave.duty ? 1 / all
                               : (1 - wave.depth) / all;
  }
  return sum / kReadings;
}

// Each of at most 18 edges, of a step of 2 at most, may lie half a reading off.
TEST(LightWave, IsItsMeanOverAnyTime) {
  for (const LightWave& wave : {kLamp, kPulses, LightWave{240, 1, 0.5}, LightWave{7, 1, {}}}) {
    for (const double from_s : {0.0, 0.0013, 12.3456}) {
      for (const double length_s : {1e-4, 0.0025, 0.0171})
        EXPECT_NEAR(mean_light(wave, from_s, length_s), sampled(wave, from_s, length_s), 1e-4)
            << wave.hertz << " from " << from_s << " for " << length_s;
    }
  }
}

TEST(LightWave, IsOneOverWholePeriodsWheneverTheyBegin) {
  for (const double from_s : {0.0, 0.00123, 54321.0987}) {
    EXPECT_NEAR(mean_light(kLamp, from_s, 0.02), 1, 1e-12);
    EXPECT_NEAR(mean_light(kPulses, from_s, 0.02), 1, 1e-10);
  }
}

TEST(LightWave, OfNoDepthOrFullDutyIsSteady) {
  EXPECT_EQ(mean_light({100, 0, {}}, 0.003, 0.004), 1);
  EXPECT_NEAR(mean_light({100, 1, 1}, 0.003, 0.004), 1, 1e-12);
}

CameraExposure opened_for(double exposure_us, double opened_s) {
  CameraExposure exposure;
  exposure.opened = RigClock::time_point(
      std::chrono::duration_cast<RigClock::duration>(std::chrono::duration<double>(opened_s)));
  exposure.exposure_us = exposure_us;
  exposure.readout_s = 1.0 / 60;
  return exposure;
}

/// The wave of so many rows in the light of rows: its amplitude and its phase.
std::complex<double> wave_of(const std::vector<double>& light, double period_rows) {
  std::complex<double> sum = 0;
  const auto rows = static_cast<std::size_t>(std::lround(
      period_rows * std::floor(static_cast<double>(light.size()) / period_rows)));  // whole periods
  for (std::size_t y = 0; y < rows; ++y)
    sum += light[y] * std::polar(1.0, -2 * kPi * static_cast<double>(y) / period_rows);
  return 2.0 * sum / static_cast<double>(rows);
}

// 240 Hz have 4 periods in a sixtieth of a second, over 1200 steps from row to row.
TEST(LightByRow, HasThePeriodAndTheDepthThatReadoutAndExposureLeaveOfIt) {
  const LightWave wave = {240, 0.4, {}};
  const double exposure_s = 1e-3;
  const std::vector<double> light = light_by_row(wave, opened_for(1e6 * exposure_s, 0), 1201);
  const std::complex<double> seen = wave_of(light, 300);
  const double left = std::sin(kPi * 240 * exposure_s) / (kPi * 240 * exposure_s);
  EXPECT_NEAR(std::abs(seen), 0.4 * left, 1e-9);
  for (const double other : {150.0, 200.0, 400.0, 600.0}) EXPECT_LT(std::abs(wave_of(light, other)), 1e-9);
  EXPECT_DOUBLE_EQ(light[0], mean_light(wave, 0, exposure_s));
  EXPECT_NEAR(light[1200], mean_light(wave, 1.0 / 60, exposure_s), 1e-12);
}

TEST(LightByRow, BeginsWhereTheClockIs) {
  const LightWave wave = {240, 0.4, {}};
  const std::complex<double> first = wave_of(light_by_row(wave, opened_for(1000, 5), 1201), 300);
  const std::complex<double> later = wave_of(light_by_row(wave, opened_for(1000, 5 + 1.0 / 960), 1201), 300);
  EXPECT_NEAR(std::arg(later / first), kPi / 2, 1e-4) << "a quarter of a period";
}

TEST(LightByRow, IsSteadyInAnExposureOfWholePeriodsOrWithoutReadout) {
  for (const double light : light_by_row({100, 0.9, {}}, opened_for(20000, 3.21), 96))
    EXPECT_NEAR(light, 1, 1e-12);
  CameraExposure at_once = opened_for(1000, 3.21);
  at_once.readout_s = 0;
  for (const double light : light_by_row(kPulses, at_once, 96))
    EXPECT_EQ(light, mean_light(kPulses, 3.21, 1e-3));
}

}  // namespace
}  // namespace weft::virtual_rig
