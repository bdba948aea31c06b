// SPDX-License-Identifier: Apache-2.0
#include "simulator/sensor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::simulator {
namespace {

constexpr std::uint32_t kDraws = 50000;

struct Statistics {
  double mean = 0;
  double variance = 0;
  double lowest = 1e9;
  double highest = -1e9;
};

/// Counts of a body for one level of light, over many photosites.
Statistics counts_of(const Sensor& sensor, double signal) {
  double sum = 0, sum_of_squares = 0;
  Statistics s;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const double count = count_of(sensor, noisy(sensor, signal, philox({i, 0, 0, 0}, {99, 0})));
    sum += count;
    sum_of_squares += count * count;
    s.lowest = std::min(s.lowest, count);
    s.highest = std::max(s.highest, count);
  }
  s.mean = sum / kDraws;
  s.variance = sum_of_squares / kDraws - s.mean * s.mean;
  return s;
}

Sensor offset_body() {
  return sensor_of(CameraSettings());
}

Sensor d5100() {
  CameraSettings camera;
  camera.body = Body::kD5100;
  return sensor_of(camera);
}

TEST(Sensor, HasTheLevelsOfItsBody) {
  EXPECT_EQ(offset_body().black, 600);
  EXPECT_EQ(offset_body().white, 15520);
  EXPECT_EQ(d5100().black, 0);
  EXPECT_EQ(d5100().white, 15846);
  EXPECT_EQ(d5100().model, "NIKON D5100");
}

TEST(Sensor, ScalesItsLevelsWithTheBits) {
  CameraSettings camera;
  camera.bits = 12;
  EXPECT_EQ(sensor_of(camera).black, 150);
  EXPECT_EQ(sensor_of(camera).white, 3880);
  camera.bits = 16;
  EXPECT_EQ(sensor_of(camera).white, 62080);
  camera.body = Body::kD5100;
  camera.bits = 12;
  EXPECT_EQ(sensor_of(camera).white, 3961) << "a whole number of counts";
}

TEST(Sensor, IsFullAtFewerElectronsWithHigherIso) {
  CameraSettings camera;
  camera.iso = 400;
  EXPECT_EQ(sensor_of(camera).electrons_at_white, 10000);
}

TEST(Sensor, CountsLightFromBlackToWhite) {
  const Sensor sensor = offset_body();
  EXPECT_EQ(count_of(sensor, 0), 600);
  EXPECT_EQ(count_of(sensor, 0.5), 8060);
  EXPECT_EQ(count_of(sensor, 0.5 + 0.6 / 14920), 8061) << "to the nearest count";
  EXPECT_EQ(count_of(sensor, 1), 15520);
  EXPECT_EQ(count_of(sensor, 1.7), 15520);
  EXPECT_EQ(count_of(sensor, 1e30), 15520);
  EXPECT_EQ(count_of(sensor, -0.01), 451) << "the offset keeps noise below black";
  EXPECT_EQ(count_of(sensor, -1), 0);
}

TEST(Sensor, ScattersAsItsResponseSays) {
  const Sensor sensor = offset_body();
  const Response response = response_of(sensor);
  for (const double signal : {0.0, 0.0005, 0.004, 0.1, 0.6}) {
    const double light = signal * (sensor.white - sensor.black);
    const double variance =
        light / response.electrons_per_count + response.read_noise_counts * response.read_noise_counts;
    const Statistics s = counts_of(sensor, signal);
    EXPECT_NEAR(s.mean, sensor.black + light, 4 * std::sqrt(variance / kDraws)) << signal;
    EXPECT_NEAR(s.variance, variance, 4 * variance * std::sqrt(2.2 / kDraws)) << signal;
  }
}

TEST(Sensor, ReadsItsDarkNoiseInElectrons) {
  const Statistics dark = counts_of(offset_body(), 0);
  const double electrons_per_count = 40000.0 / 14920;
  EXPECT_NEAR(std::sqrt(dark.variance - 1.0 / 12) * electrons_per_count, 3, 0.05);
}

TEST(Sensor, NeverCountsAboveWhite) {
  for (const Sensor& sensor : {offset_body(), d5100()}) {
    EXPECT_EQ(counts_of(sensor, 0.999).highest, sensor.white);
    EXPECT_EQ(counts_of(sensor, 1.5).lowest, sensor.white);
  }
}

TEST(Sensor, OfTheD5100ClipsTheDarkAtZero) {
  const Sensor sensor = d5100();
  const Statistics dark = counts_of(sensor, 0);
  EXPECT_EQ(dark.lowest, 0);
  // The mean of a normal variable that is clipped at 0 is sigma / sqrt(2 pi); rounding adds a little.
  const double sigma = response_of(sensor).read_noise_counts;
  EXPECT_NEAR(dark.mean, sigma / std::sqrt(2 * kPi), 0.05);
  EXPECT_NEAR(counts_of(offset_body(), 0).mean, 600, 0.05) << "the other body's dark is unbiased";
}

}  // namespace
}  // namespace weft::simulator
