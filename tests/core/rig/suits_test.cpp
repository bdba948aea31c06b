// SPDX-License-Identifier: Apache-2.0
#include "core/rig/suits.h"
#include "core/rig/same_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace weft {
namespace {

using testing::HasSubstr;

// A calibration of three LEDs, a session that lit them all, and what its frames say of the camera.
struct Match {
  Calibration calibration;
  Session session;
  ShotMetadata frame;

  Match() {
    calibration.subject = {"rig A", "NIKON D5100", "6012345", 8, AlbedoScale::kAbsolute};
    calibration.camera = CameraModel();
    calibration.response = Response();
    NearLights lights;
    lights.leds.resize(3);
    calibration.lights = lights;
    session.folder = "archive/linen.weft";
    session.rig = "rig A";
    for (int led = 0; led <= 3; ++led) {
      Shot shot;
      shot.led = led;
      shot.role = led == 0 ? ShotRole::kDark : ShotRole::kLit;
      shot.file = "raw/0" + std::to_string(led) + ".nef";
      shot.f_number = 8;
      session.shots.push_back(shot);
    }
    frame.model = "NIKON D5100";
    frame.serial = "6012345";
  }

  std::string verdict() const {
    const Result<void> result = suits(calibration, session, frame);
    if (result) return "suits";
    EXPECT_EQ(result.error().kind, ErrorKind::kBadData);
    EXPECT_EQ(result.error().where, "archive/linen.weft");
    EXPECT_THAT(result.error().remedy, HasSubstr("--calibration"));
    return result.error().why;
  }
};

TEST(Suits, ACalibrationOfTheSameRigBodyAndAperture) {
  EXPECT_EQ(Match().verdict(), "suits");
}

TEST(Suits, NotTheCalibrationOfAnotherRig) {
  Match match;
  match.session.rig = "rig B";
  EXPECT_EQ(match.verdict(), "it is of rig \"rig A\", the session of \"rig B\"");
}

TEST(Suits, NotThatOfAnotherCameraModel) {
  Match match;
  match.frame.model = "NIKON D90";
  EXPECT_EQ(match.verdict(), "the calibration is of a NIKON D5100, the frame of a NIKON D90");
}

TEST(Suits, NotThatOfAnotherBodyOfTheSameModel) {
  Match match;
  match.frame.serial = "6099999";
  EXPECT_EQ(match.verdict(),
            "the calibration is of the body with serial number 6012345, the frame of 6099999");
}

TEST(Suits, WhereFramesDoNotSayWhatTookThem) {
  Match match;
  match.frame = {};
  EXPECT_EQ(match.verdict(), "suits");
  match.frame.serial = "6099999";
  match.calibration.subject.camera_serial.clear();
  EXPECT_EQ(match.verdict(), "suits") << "the calibration knows no serial number";
}

TEST(Suits, NotAtAnotherApertureOfAnyShot) {
  for (std::size_t shot = 0; shot < 4; ++shot) {
    Match match;
    match.session.shots[shot].f_number = 5.6;
    EXPECT_EQ(match.verdict(), "it holds at f/8, raw/0" + std::to_string(shot) + ".nef was taken at f/5.6");
  }
}

TEST(Suits, HoweverItsApertureWasRounded) {
  for (const double f_number : {1.4, 2.8, 5.6, 6.3}) {
    Match match;
    for (Shot& shot : match.session.shots) shot.f_number = f_number;
    match.calibration.subject.f_number = double{static_cast<float>(f_number)};
    match.frame.f_number = f_number + 0.01;
    EXPECT_EQ(match.verdict(), "suits") << "f/" << f_number;
  }
  EXPECT_FALSE(same_setting(5.6, 6.3)) << "a third of a stop";
}

TEST(Suits, NotAtAnotherFocalLengthWhereBothSayTheirs) {
  Match match;
  match.calibration.subject.focal_length_mm = 35;
  EXPECT_EQ(match.verdict(), "suits") << "the frame does not say";
  for (const double same_mm : {34.4, 35.0, 35.6}) {
    match.frame.focal_mm = same_mm;
    EXPECT_EQ(match.verdict(), "suits") << same_mm << " mm";
  }
  match.frame.focal_mm = 40;
  EXPECT_EQ(match.verdict(), "focal length 40 mm, not 35: turn the zoom back or calibrate again");
  match.calibration.subject.focal_length_mm = 0;
  EXPECT_EQ(match.verdict(), "suits") << "the calibration does not say";
}

TEST(Suits, NotAtAnotherIsoThanItsResponseWasMeasuredAt) {
  Match match;
  for (Shot& shot : match.session.shots) shot.iso = 100;
  match.calibration.response->iso = 400;
  EXPECT_EQ(match.verdict(), "its response was measured at ISO 400, raw/00.nef was taken at ISO 100");
  match.calibration.response->iso = 100;
  EXPECT_EQ(match.verdict(), "suits");
}

TEST(Suits, NotWithALedItDoesNotMeasure) {
  Match match;
  match.session.shots[3].led = 4;
  EXPECT_EQ(match.verdict(), "it measures 3 LEDs, raw/03.nef lit LED 4");
  match.session.shots[3].led = 1;
  EXPECT_EQ(match.verdict(), "suits") << "a session may light fewer LEDs";
}

TEST(Suits, NotWithoutAllPartsThatASolveNeeds) {
  for (const char* part : {"lights.json", "camera.json", "response.json"}) {
    Match match;
    if (part == std::string("lights.json")) match.calibration.lights.reset();
    if (part == std::string("camera.json")) match.calibration.camera.reset();
    if (part == std::string("response.json")) match.calibration.response.reset();
    EXPECT_EQ(match.verdict(), std::string("it has no ") + part);
  }
}

}  // namespace
}  // namespace weft
