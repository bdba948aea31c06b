// SPDX-License-Identifier: Apache-2.0
#include "calibration/response/response_measurement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/oracles/virtual_sensor.h"

namespace weft::calibration {
namespace {

using test::VirtualSensor;
using testing::HasSubstr;

// A still scene at four exposures, two frames of each, under the lights that a test asks for.
struct Capture {
  VirtualSensor sensor = VirtualSensor::of(simulator::Body::kOffset);
  ResponseFrames frames;
  int takes = 0;

  // `light` is what fills the brightest photosite in 100 ms.
  void take(const std::vector<int>& leds, double light) {
    for (const double exposure_ms : {10, 20, 40, 80}) {
      ExposureFrames& exposure = frames.by_leds[leds].emplace_back();
      exposure.exposure_us = 1000 * exposure_ms;
      exposure.files = {"first.dng", "second.dng"};
      const auto frame = [&] {
        return sensor.frame({160, 128}, takes++, exposure.exposure_us, [&](int x, int, int) {
          return light * exposure_ms / 100 * (0.5 + 0.5 * x / 160);
        });
      };
      const RawFrame first = frame(), second = frame();
      for (const RawFrame* each : {&first, &second}) {
        const BlockLight seen = block_light(*each, {});
        join(exposure.light, seen);
        exposure.brightness.push_back(seen.mean[0] + seen.mean[1] + seen.mean[2]);
      }
      const std::vector<TransferPoint> points = transfer_points(first, second, {});
      frames.transfer.insert(frames.transfer.end(), points.begin(), points.end());
      frames.size = first.counts.size();
      frames.file_black = first.black;
      frames.file_white = static_cast<double>(first.white);
    }
  }

  std::string refusal() const {
    const Result<ResponseMeasurement> measured = measure_response(frames);
    return measured ? "measured" : measured.error().message();
  }
};

TEST(ResponseMeasurement, TakesTheBlackLevelFromTheBestFramesThatThereAre) {
  Capture capture;
  capture.take({}, 0);
  capture.take({1}, 0.5);
  capture.take({2}, 0.4);
  capture.take({1, 2}, 0.9);
  for (const BlackFrom from : {BlackFrom::kDarkFrames, BlackFrom::kSuperposition, BlackFrom::kExposures}) {
    const Result<ResponseMeasurement> measured = measure_response(capture.frames);
    ASSERT_TRUE(measured) << measured.error().message();
    EXPECT_STREQ(name_of(measured->black_from), name_of(from));
    EXPECT_NEAR(measured->black_counts, capture.sensor.sensor.black, 1) << "from " << name_of(from);
    EXPECT_EQ(measured->superposition.has_value(), from != BlackFrom::kExposures);
    capture.frames.by_leds.erase(from == BlackFrom::kDarkFrames ? std::vector<int>()
                                                                : std::vector<int>{1, 2});
  }
}

TEST(ResponseMeasurement, FindsNoiseRatiosOfExposuresAndTheBalanceOfLeds) {
  Capture capture;
  capture.take({}, 0);
  capture.take({1}, 0.8);
  capture.take({2}, 0.4);
  const Result<ResponseMeasurement> measured = measure_response(capture.frames);
  ASSERT_TRUE(measured) << measured.error().message();
  const Response truth = response_of(capture.sensor.sensor);
  EXPECT_NEAR(measured->response.electrons_per_count / truth.electrons_per_count, 1, 0.03);
  const std::optional<double> ratio = measured->response.exposure_ratio(80000, 20000);
  ASSERT_TRUE(ratio);
  EXPECT_NEAR(*ratio, 4, 0.02);
  ASSERT_EQ(measured->balance.size(), 2u);
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(measured->balance[1].light[c] / measured->balance[0].light[c], 0.5, 0.005) << "channel " << c;
}

TEST(ResponseMeasurement, RefusesLightThatIsNotWhatItIsCalled) {
  Capture dim;
  dim.take({}, 0);
  dim.take({1}, 0.8);
  dim.take({2}, 0.01);
  EXPECT_THAT(dim.refusal(), HasSubstr("a LED did not light"));
  Capture one_of_two;
  one_of_two.take({}, 0);
  one_of_two.take({1}, 0.8);
  one_of_two.take({2}, 0.4);
  one_of_two.take({1, 2}, 0.8);
  EXPECT_THAT(one_of_two.refusal(), HasSubstr("led01+led02 gives 66.7 percent"));
  Capture few;
  few.take({}, 0);
  EXPECT_THAT(few.refusal(), HasSubstr("too few levels of light"));
}

}  // namespace
}  // namespace weft::calibration
