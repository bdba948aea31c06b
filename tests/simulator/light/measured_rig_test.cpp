// SPDX-License-Identifier: Apache-2.0
#include "simulator/light/measured_rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/core/places.h"

namespace weft::simulator {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

fs::path put(const std::string& text) {
  const fs::path file = fs::path(testing::TempDir()) / "measured_rig.json";
  std::ofstream(file) << text;
  return file;
}

std::string refusal(const std::string& text) {
  const auto leds = read_measured_rig(put(text), 600);
  if (leds) return "nothing was refused";
  EXPECT_EQ(leds.error().kind, ErrorKind::kBadData);
  return leds.error().message();
}

TEST(MeasuredRig, TurnsTheFrameOfItsCameraIntoThatOfTheRig) {
  const auto leds = read_measured_rig(put(R"({"note": "two", "leds": [
      {"position_mm": [100, -50, 200], "direction": [0, 0, 2], "mu": 1, "flux_rgb": [1, 2, 3]},
      {"position_mm": [-30, 40, 100], "direction": [0.6, 0, 0.8], "mu": 0, "flux_rgb": [4, 5, 6]}]})"),
                                      600);
  ASSERT_TRUE(leds) << leds.error().message();
  ASSERT_EQ(leds->size(), 2U);
  EXPECT_EQ((*leds)[0].position_mm, (Vec3{100, 50, 400}));
  EXPECT_EQ((*leds)[0].aim, (Vec3{0, 0, -1})) << "unit, and down";
  EXPECT_EQ((*leds)[1].position_mm, (Vec3{-30, -40, 500}));
  EXPECT_LT(length((*leds)[1].aim - Vec3{0.6, 0, -0.8}), 1e-15);
  EXPECT_EQ((*leds)[1].mu, 0);
  EXPECT_EQ((*leds)[1].flux_rgb, (std::array<double, 3>{4, 5, 6}));
}

TEST(MeasuredRig, LeavesTheLightsOfACalibrationInTheirFrame) {
  const fs::path schemas = source_folder() / "testdata" / "schemas";
  const auto leds = read_measured_rig(schemas / "weft.calibration-1" / "lights.json", 600);
  ASSERT_TRUE(leds) << leds.error().message();
  ASSERT_EQ(leds->size(), 3U);
  EXPECT_EQ((*leds)[2].position_mm, (Vec3{-150, -260, 510}));
  EXPECT_LT(length((*leds)[2].aim - Vec3{0.36, 0.48, -0.8}), 1e-15);
  EXPECT_EQ((*leds)[2].mu, 0.9);
  EXPECT_EQ((*leds)[2].flux_rgb[0], 105000);

  const auto distant = read_measured_rig(schemas / "weft.calibration-1-distant" / "lights.json", 600);
  ASSERT_FALSE(distant);
  EXPECT_THAT(distant.error().message(), HasSubstr("must be \"near\""));
}

TEST(MeasuredRig, RefusesWhatMakesNoSenseAndNamesTheLed) {
  const auto with = [](const std::string& led) { return refusal(R"({"leds": [)" + led + "]}"); };
  EXPECT_THAT(refusal("{"), HasSubstr("not an object"));
  EXPECT_THAT(refusal("[1]"), HasSubstr("not an object"));
  EXPECT_THAT(refusal(std::string(1000, '[')), HasSubstr("nested over 16 deep"));
  EXPECT_THAT(refusal("{}"), HasSubstr("\"leds\" is missing"));
  EXPECT_THAT(with(""), HasSubstr("it has 0 LEDs"));
  EXPECT_THAT(with(R"({"position_mm": [0, 0]})"), AllOf(HasSubstr("LED 1"), HasSubstr("position_mm")));
  EXPECT_THAT(with(R"({"position_mm": [0, 0, 9], "direction": [0, 0, 0], "mu": 1, "flux_rgb": [1, 1, 1]})"),
              AllOf(HasSubstr("direction"), HasSubstr("longer than 0")));
  EXPECT_THAT(with(R"({"position_mm": [0, 0, 9], "direction": [0, 0, 1], "mu": -1, "flux_rgb": [1, 1, 1]})"),
              HasSubstr("\"mu\" must not be negative"));
  EXPECT_THAT(with(R"({"position_mm": [0, 0, 9], "direction": [0, 0, 1], "mu": 1, "flux_rgb": [1, 0, 1]})"),
              HasSubstr("above 0 in every channel"));
  EXPECT_THAT(refusal(R"({"schema": "weft.camera/1"})"), HasSubstr("weft.lights/1"));
  EXPECT_EQ(read_measured_rig("none.json", 600).error().kind, ErrorKind::kNoInput);
}

TEST(MeasuredRig, ReadsAPublishedRigWithItsLedsBesideTheCameraAimedAtTheCloth) {
  const char* shared = std::getenv("WEFT_SHARED_DATA");
  if (shared == nullptr) GTEST_SKIP() << "WEFT_SHARED_DATA is not set";
  const auto leds = read_measured_rig(fs::path(shared) / "near_led_rig.json", 700);
  ASSERT_TRUE(leds) << leds.error().message();
  ASSERT_EQ(leds->size(), 8U);
  EXPECT_EQ((*leds)[0].position_mm, (Vec3{-219.43943851, 57.91766501, 700 - 517.00928674}));
  for (const NearLight& led : *leds) {
    EXPECT_NEAR(length(led.aim), 1, 1e-15);
    EXPECT_LT(led.aim.z, 0) << "down";
    EXPECT_LT(dot(led.aim, {led.position_mm.x, led.position_mm.y, 0}), 0) << "inwards";
  }
}

}  // namespace
}  // namespace weft::simulator
