// SPDX-License-Identifier: Apache-2.0
#include "calibration/response/photon_transfer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bench/oracles/virtual_sensor.h"

namespace weft::calibration {
namespace {

using test::VirtualSensor;
using testing::HasSubstr;

constexpr Size kTransferFrame = {128, 96};

std::vector<TransferPoint> points_of(const VirtualSensor& sensor, const std::vector<double>& levels) {
  std::vector<TransferPoint> points;
  int take = 0;
  for (const double level : levels) {
    const auto signal = [&](int x, int, int) { return level * (0.5 + 0.5 * x / kTransferFrame.width); };
    const RawFrame first = sensor.frame(kTransferFrame, take++, 1000, signal);
    const RawFrame second = sensor.frame(kTransferFrame, take++, 1000, signal);
    for (const TransferPoint& p : transfer_points(first, second, {})) points.push_back(p);
  }
  return points;
}

const std::vector<double> kLevels = {0.003, 0.01, 0.03, 0.1, 0.3, 0.6, 0.9};

TEST(PhotonTransfer, FindsGainAndReadNoiseWithinItsOwnSigma) {
  for (const auto body : {simulator::Body::kOffset, simulator::Body::kD5100}) {
    VirtualSensor sensor = VirtualSensor::of(body);
    const Response truth = response_of(sensor.sensor);
    double gain_square = 0, read_square = 0, chi_square = 0;
    constexpr int kSeeds = 12;
    for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
      sensor.seed = seed;
      const auto fit =
          fit_photon_transfer(points_of(sensor, kLevels), {}, sensor.sensor.white - sensor.sensor.black);
      ASSERT_TRUE(fit) << fit.error().message();
      const double gain_off =
          (fit->electrons_per_count - truth.electrons_per_count) / fit->sigma_electrons_per_count;
      const double read_off =
          (fit->read_noise_counts - truth.read_noise_counts) / fit->sigma_read_noise_counts;
      gain_square += gain_off * gain_off / kSeeds;
      read_square += read_off * read_off / kSeeds;
      EXPECT_LT(fit->sigma_electrons_per_count, 0.01 * truth.electrons_per_count);
      chi_square += fit->chi_square_per_freedom / kSeeds;
    }
    EXPECT_NEAR(chi_square, 1, 0.09);  // 4 sigma of 12 means over 336 squares
    // The mean square of 12 standard normals is below 2.2 but for one time in a hundred.
    EXPECT_LT(gain_square, 2.2) << "body " << static_cast<int>(body);
    EXPECT_LT(read_square, 2.2) << "body " << static_cast<int>(body);
    EXPECT_GT(gain_square, 0.25) << "sigma is not too large either";
  }
}

TEST(PhotonTransfer, TakesABentResponseOutBeforeItLooksAtVariance) {
  VirtualSensor sensor = VirtualSensor::of(simulator::Body::kOffset);
  sensor.linearity = {0.06, -0.02};
  const double full = sensor.sensor.white - sensor.sensor.black;
  const auto points = points_of(sensor, kLevels);
  TransferCurve curve;
  curve.linearity.fill(sensor.linearity);
  const auto known = fit_photon_transfer(points, curve, full),
             ignored = fit_photon_transfer(points, {}, full);
  ASSERT_TRUE(known && ignored);
  const double truth = sensor.sensor.electrons_per_count();
  EXPECT_NEAR(known->electrons_per_count, truth, 4 * known->sigma_electrons_per_count);
  EXPECT_GT(std::abs(ignored->electrons_per_count - truth), 5 * ignored->sigma_electrons_per_count);
}

TEST(PhotonTransfer, SeesNeitherSceneNorFixedPattern) {
  const VirtualSensor sensor = VirtualSensor::of(simulator::Body::kOffset);
  const auto stripes = [](int x, int y, int) { return 0.2 + 0.15 * ((x / 3 + y / 5) % 2); };
  const auto points = transfer_points(sensor.frame(kTransferFrame, 0, 1000, stripes),
                                      sensor.frame(kTransferFrame, 1, 1000, stripes), {});
  ASSERT_EQ(points.size(), 4U * 3 * 4);
  const Response truth = response_of(sensor.sensor);
  double ratio = 0;
  for (const TransferPoint& p : points) {
    const double signal = p.v * (sensor.sensor.white - sensor.sensor.black);
    ratio += p.variance_counts2 /
             (signal / truth.electrons_per_count + truth.read_noise_counts * truth.read_noise_counts) /
             static_cast<double>(points.size());
  }
  EXPECT_NEAR(ratio, 1, 4 * std::sqrt(2.0 / (255.0 * static_cast<double>(points.size()))));
}

TEST(PhotonTransfer, IgnoresAChangeOfBrightnessBetweenTheTwoFrames) {
  const VirtualSensor sensor = VirtualSensor::of(simulator::Body::kOffset);
  const auto light = [](double gain) { return [gain](int, int, int) { return 0.5 * gain; }; };
  const auto alike = transfer_points(sensor.frame(kTransferFrame, 0, 1000, light(1)),
                                     sensor.frame(kTransferFrame, 1, 1000, light(1)), {});
  const auto drifted = transfer_points(sensor.frame(kTransferFrame, 0, 1000, light(1)),
                                       sensor.frame(kTransferFrame, 1, 1000, light(1.01)), {});
  double a = 0, b = 0;
  for (const TransferPoint& p : alike) a += p.variance_counts2;
  for (const TransferPoint& p : drifted) b += p.variance_counts2;
  EXPECT_NEAR(b / a, 1.005, 0.005);
}

TEST(PhotonTransfer, RefusesOneLevelOfLight) {
  const VirtualSensor sensor = VirtualSensor::of(simulator::Body::kOffset);
  const auto fit = fit_photon_transfer(points_of(sensor, {0.5}), {}, 14920);
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message(), HasSubstr("more exposures"));
  const auto none = fit_photon_transfer({}, {}, 14920);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message(), HasSubstr("neither full nor black"));
}

TEST(PhotonTransfer, RefusesFramesThatWereSmoothed) {
  std::vector<TransferPoint> points;
  for (int i = 1; i < 40; ++i) points.push_back({1, 0.02 * i, 5 - 0.1 * i, 255});
  const auto fit = fit_photon_transfer(points, {}, 14920);
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message(), HasSubstr("noise reduction"));
}

}  // namespace
}  // namespace weft::calibration
