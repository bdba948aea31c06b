// SPDX-License-Identifier: Apache-2.0
#include "calibration/response/response_measurement.h"

#include <gtest/gtest.h>

#include "bench/oracles/virtual_sensor.h"

namespace weft::calibration {
namespace {

constexpr Size kRatioFrame = {128, 96};

BlockLight light_of(const test::VirtualSensor& sensor, int take, double level) {
  return block_light(sensor.frame(kRatioFrame, take, 1000,
                                  [&](int x, int, int c) {
                                    return level * (0.5 + 0.5 * (x | 1) / kRatioFrame.width) *
                                           (c == 1 ? 1.0 : 0.6);
                                  }),
                     {});
}

TEST(LightRatio, IsThatOfTheLightAndNotOfCounts) {
  test::VirtualSensor sensor = test::VirtualSensor::of(simulator::Body::kOffset);
  sensor.linearity = {0.05, -0.02};
  TransferCurve curve;
  curve.linearity.fill(sensor.linearity);
  const BlockLight longer = light_of(sensor, 0, 0.8), shorter = light_of(sensor, 1, 0.2);
  EXPECT_NEAR(*light_ratio(longer, shorter, curve), 4, 4 * 5e-4);
  EXPECT_GT(std::abs(*light_ratio(longer, shorter, {}) - 4), 0.02);
}

TEST(LightRatio, UsesWhatIsFullInNeither) {
  const test::VirtualSensor sensor = test::VirtualSensor::of(simulator::Body::kOffset);
  const BlockLight longer = light_of(sensor, 0, 1.4), shorter = light_of(sensor, 1, 0.35);
  EXPECT_GT(longer.full_share[1], 0.3);
  EXPECT_NEAR(*light_ratio(longer, shorter, {}), 4, 4 * 1e-3);
  EXPECT_FALSE(light_ratio(light_of(sensor, 2, 9), shorter, {}));
}

TEST(LightByChannel, IsTheWhiteBalance) {
  const test::VirtualSensor sensor = test::VirtualSensor::of(simulator::Body::kOffset);
  const auto light = light_by_channel(light_of(sensor, 0, 0.8), {});
  ASSERT_TRUE(light);
  EXPECT_NEAR((*light)[0] / (*light)[1], 0.6, 0.001);
  EXPECT_NEAR((*light)[2] / (*light)[1], 0.6, 0.001);
}

TEST(LevelAtNoExposure, IsTheBlackLevelWhereTimesAreNearlyTrue) {
  const test::VirtualSensor sensor = test::VirtualSensor::of(simulator::Body::kD5100);
  const std::vector<double> shares = {0.02, 0.1, 0.4, 0.9};
  const std::vector<double> errors = {1.001, 0.999, 1.0015, 0.9995};
  std::vector<BlockLight> lights;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    lights.push_back(light_of(sensor, static_cast<int>(i), shares[i] * errors[i]));
  }
  std::vector<TimedLight> led;
  for (std::size_t i = 0; i < shares.size(); ++i) led.push_back({&lights[i], 1e5 * shares[i]});
  const std::vector<std::vector<TimedLight>> leds = {led};
  const auto level = level_at_no_exposure(leds);
  ASSERT_TRUE(level);
  EXPECT_NEAR(level->v, 0, 4 * level->sigma);
  EXPECT_LT(level->sigma, 1e-4);
  led.resize(2);
  EXPECT_FALSE(level_at_no_exposure(std::vector<std::vector<TimedLight>>{led}));
}

}  // namespace
}  // namespace weft::calibration
