// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/sensor.h"

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
Statistics counts_of(const Sensor& sensor, double signal, std::uint32_t draws = kDraws,
                     std::uint32_t stream = 0) {
  double sum = 0, sum_of_squares = 0;
  Statistics s;
  for (std::uint32_t i = 0; i < draws; ++i) {
    const double count = count_of(sensor, noisy(sensor, signal, philox({i, stream, 0, 0}, {99, 0})));
    sum += count;
    sum_of_squares += count * count;
    s.lowest = std::min(s.lowest, count);
    s.highest = std::max(s.highest, count);
  }
  s.mean = sum / draws;
  s.variance = sum_of_squares / draws - s.mean * s.mean;
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

/// Gain and read noise as a laboratory finds them: a straight line through variance over mean of flat frames
/// (Janesick, "Photon Transfer", 2007), the 1/12 count^2 of whole counts taken off.
TEST(Sensor, ShowsItsGainAndReadNoiseInThePhotonTransferCurve) {
  struct Case {
    int bits;
    double read_noise_electrons;  // over a count, so that rounding adds 1/12 count^2
  };
  for (const Case& c : {Case{12, 12}, Case{14, 3}}) {
    CameraSettings camera;
    camera.bits = c.bits;
    camera.read_noise_electrons = c.read_noise_electrons;
    const Sensor sensor = sensor_of(camera);
    const double dark_variance = counts_of(sensor, 0, 4 * kDraws).variance - 1.0 / 12;
    double means = 0, variances = 0;
    std::uint32_t stream = 1;
    for (const double signal : {0.1, 0.25, 0.4, 0.55, 0.7, 0.8}) {
      const Statistics flat = counts_of(sensor, signal, 2 * kDraws, stream++);
      means += flat.mean - sensor.black;
      variances += flat.variance - 1.0 / 12 - dark_variance;
    }
    const double electrons_per_count = means / variances;
    EXPECT_NEAR(electrons_per_count, 40000 / (sensor.white - sensor.black), 0.01 * electrons_per_count)
        << c.bits << " bits";
    EXPECT_NEAR(std::sqrt(dark_variance) * electrons_per_count, c.read_noise_electrons,
                0.01 * c.read_noise_electrons)
        << c.bits << " bits";
  }
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
