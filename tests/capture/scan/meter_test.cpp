// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/meter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "capture/scan/light_fit.h"
#include "capture/scan/scan_plan.h"
#include "tests/capture/scan/simulated_rig.h"

namespace weft::capture {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

std::vector<double> thirds_of_stops() {
  std::vector<double> times;
  for (int i = -36; i <= 15; ++i) times.push_back(std::round(1e6 * std::exp2(i / 3.0)));
  return times;
}

/// Test shots of a simulated cloth, and what they came to.
struct TestTable {
  explicit TestTable(simulator::Scene scene) : cloth(std::move(scene)) {
    for (int led = 1; led <= cloth.leds(); ++led) input.leds.push_back(led);
    input.shutter_times_us = thirds_of_stops();
    input.start_us = 8000;
  }

  void expect_flat_cloth() {
    const Result<PatchLights> model = PatchLights::make(cloth.calibration(), 0);
    ASSERT_TRUE(model) << model.error().message();
    input = meter_input(input.leds, input.shutter_times_us, *model, 100);
  }

  Brightness shot(int led, double exposure_us) {
    ++shots;
    RawFrame frame = cloth.photograph({{{led, gain[static_cast<std::size_t>(led - 1)]}}, 0}, exposure_us,
                                      static_cast<std::uint32_t>(shots));
    for (int y = 0; y < frame.counts.height(); ++y)
      for (int x = 0; x < frame.counts.width(); ++x) frame.counts(x, y) = std::min(frame.counts(x, y), stop);
    frame.full = full;
    return reader.read(std::move(frame));
  }

  Metering metered() {
    const Result<Metering> done =
        meter(input, [&](int led, double us) -> Result<Brightness> { return shot(led, us); });
    EXPECT_TRUE(done) << done.error().message();
    return done ? *done : Metering();
  }

  test::SimulatedCloth cloth;
  MeterInput input;
  std::vector<double> gain = std::vector<double>(10, 1);
  int shots = 0;
  std::uint16_t stop = 65535;  ///< of all channels
  std::array<float, 3> full = {};
  TestShotReader reader;
};

double brightest(TestTable& rig, double exposure_us) {
  double most = 0;
  for (const int led : rig.input.leds) most = std::max(most, rig.shot(led, exposure_us).bright);
  return most;
}

TEST(Meter, BringsTheBrightestLedToFourFifthsWithinAThirdOfAStop) {
  TestTable rig(test::small_scene());
  const Metering metering = rig.metered();
  const double bright = brightest(rig, metering.exposure_us);
  EXPECT_LE(bright, 0.83);
  EXPECT_GE(bright, 0.8 / std::exp2(1.0 / 3) * 0.97);
  EXPECT_THAT(metering.warnings, IsEmpty());
}

TEST(Meter, FindsTheSameFromAStartFarOffOnEitherSide) {
  TestTable rig(test::small_scene());
  const double exposure_us = rig.metered().exposure_us;
  for (const double start_us : {250.0, 1e6}) {
    rig.input.start_us = start_us;
    EXPECT_EQ(rig.metered().exposure_us, exposure_us) << "from " << start_us << " us";
  }
}

TEST(Meter, SeesByItselfWhereACameraStopsBelowWhite) {
  TestTable known(test::small_scene());
  known.stop = 12000;
  known.full = {12000, 12000, 12000};
  known.input.start_us = 1e6;
  TestTable unknown(test::small_scene());
  unknown.stop = 12000;
  unknown.input.start_us = 1e6;
  const double exposure_us = unknown.metered().exposure_us;
  EXPECT_EQ(exposure_us, known.metered().exposure_us);
  EXPECT_GT(brightest(known, exposure_us), 0.6);
}

TEST(Meter, NeedsTwoTestShotsWhereTheLightsAreKnown) {
  TestTable rig(test::small_scene());
  rig.expect_flat_cloth();
  rig.metered();
  EXPECT_LE(rig.shots, 3);
}

TEST(Meter, TriesEachLedWhereTheLightsAreNotAsExpected) {
  TestTable rig(test::small_scene());
  rig.expect_flat_cloth();
  const double before_us = rig.metered().exposure_us;
  rig.gain = {1, 1, 1, 1, 0.7, 0.7, 0.7, 0.7, 0.7, 0.7};
  rig.gain[2] = 2;
  rig.shots = 0;
  const double after_us = rig.metered().exposure_us;
  EXPECT_GE(rig.shots, 10);
  EXPECT_NEAR(before_us / after_us, 2, 0.6) << "LED 3 gives twice the light";
}

TEST(Meter, KeepsEveryLedOfAGlossyClothFromClippingAndNamesABracket) {
  simulator::Scene scene = test::small_scene();
  scene.geometry = {};
  scene.material.reflectance = simulator::Ggx{.alpha = 0.15};
  scene.effects.reflectance = true;
  scene.camera.pose.tilt_deg = 20;
  TestTable rig(scene);
  const Metering metering = rig.metered();
  for (const int led : rig.input.leds) {
    EXPECT_LE(rig.shot(led, metering.exposure_us).clipped, 1e-5) << "LED " << led;
  }
}

TEST(Meter, IsToldByOneReadableShotOfAnyLedWhereTheLightsAreKnown) {
  TestTable rig(test::small_scene());
  rig.expect_flat_cloth();
  const double exposure_us = rig.metered().exposure_us;
  for (const int led : rig.input.leds) {
    const std::optional<double> told_us =
        metered_by({led, exposure_us / 4, rig.shot(led, exposure_us / 4)}, rig.input);
    ASSERT_TRUE(told_us) << "LED " << led;
    EXPECT_LE(std::abs(std::log2(*told_us / exposure_us)), 0.34)
        << "LED " << led << " tells " << *told_us << " us, the meter " << exposure_us << " us";
  }
  EXPECT_EQ(metered_by({1, 8 * exposure_us, rig.shot(1, 8 * exposure_us)}, rig.input), std::nullopt)
      << "it is full";
}

TEST(Meter, ScalesAShotOfADimLedToTheBrightest) {
  const MeterInput input = {{1, 2}, {3, 6}, {1000, 2000, 4000, 8000}, 1000};
  EXPECT_EQ(metered_by({1, 1000, {0.2, 0.2, 0}}, input), 2000) << "0.8 / 0.2 / 2 ms";
  EXPECT_EQ(metered_by({2, 1000, {0.2, 0.2, 0}}, input), 4000);
}

TEST(Meter, SuggestsABracketWhereHighlightsHoldTheExposure) {
  MeterInput input = {{1}, {}, thirds_of_stops(), 8000};
  const Result<Metering> metering = meter(input, [](int, double us) -> Result<Brightness> {
    return Brightness{0.1 * us / 8000, std::min(0.9 * us / 8000, 1.0), us > 8800 ? 1e-3 : 0};
  });
  ASSERT_TRUE(metering) << metering.error().message();
  EXPECT_NEAR(metering->exposure_us, 7813, 1);
  ASSERT_EQ(metering->warnings.size(), 1u);
  EXPECT_THAT(metering->warnings.front(), HasSubstr("a bracket of 8 times"));
}

TEST(Meter, RecordsTheLedThatDecidesAndItsTestShots) {
  MeterInput input = {{4, 7}, {}, {}, 8000};
  const Result<Metering> metering = meter(input, [](int led, double us) -> Result<Brightness> {
    return Brightness{(led == 7 ? 0.4 : 0.2) * us / 8000, (led == 7 ? 0.5 : 0.25) * us / 8000, 0};
  });
  ASSERT_TRUE(metering) << metering.error().message();
  const Json record = to_json(*metering);
  EXPECT_EQ(record["led"], 7) << record;
  EXPECT_NEAR(record["wanted_us"].get<double>(), 0.95 / 0.5 * 8000, 1e-6) << "under 0.8 / 0.4 * 8000";
  ASSERT_EQ(record["test_shots"].size(), 2U);
  EXPECT_EQ(
      record["test_shots"][1],
      Json({{"led", 7}, {"exposure_us", 8000.0}, {"bright", 0.4}, {"brightest", 0.5}, {"clipped", 0.0}}));
}

TEST(Meter, SaysThatAClothIsTooDarkOrTooBright) {
  MeterInput input = {{3}, {}, thirds_of_stops(), 8000};
  const auto dark = meter(input, [](int, double) -> Result<Brightness> {
    return Brightness{0.001, 0.002, 0};
  });
  ASSERT_FALSE(dark);
  EXPECT_EQ(dark.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(dark.error().message(), HasSubstr("too dark: LED 3"));
  const auto full = meter(input, [](int, double) -> Result<Brightness> { return Brightness{1, 1, 1}; });
  ASSERT_FALSE(full);
  EXPECT_THAT(full.error().message(), HasSubstr("too bright: LED 3"));
}

TEST(Meter, GivesUpSoonOnALedThatIsDeadWhereTheLightsAreKnown) {
  for (const std::size_t dead : {0u, 4u}) {
    TestTable table(test::small_scene());
    table.expect_flat_cloth();
    table.gain[dead] = 0;
    table.input.expected[dead] = 10;  // the first to be tried
    double longest_us = 0;
    const Result<Metering> done = meter(table.input, [&](int led, double us) -> Result<Brightness> {
      longest_us = std::max(longest_us, us);
      return table.shot(led, us);
    });
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().what, "cloth is too dark");
    EXPECT_THAT(done.error().remedy, HasSubstr("check that the LED lights"));
    EXPECT_LE(longest_us, 101 * table.input.start_us) << "microseconds of the longest test shot";
    EXPECT_LE(table.shots, 4);
  }
}

TEST(Meter, PassesOnTheErrorOfATestShot) {
  MeterInput input = {{1}, {}, thirds_of_stops(), 8000};
  const auto failed = meter(input, [](int, double) -> Result<Brightness> {
    return Error{ErrorKind::kNoDevice, "camera is gone", "", "", ""};
  });
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().kind, ErrorKind::kNoDevice);
}

}  // namespace
}  // namespace weft::capture
