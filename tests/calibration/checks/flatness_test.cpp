// SPDX-License-Identifier: Apache-2.0
#include "calibration/checks/flatness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "calibration/lights/sheet.h"
#include "simulator/light/incidence.h"
#include "tests/calibration/checks/moved_rig.h"

namespace weft::calibration {
namespace {

constexpr int kColumns = 12, kRows = 8, kSquare_px = 128;

struct Rig {
  CameraModel camera;
  NearLights lights;
};

Rig rig() {
  const Calibration calibration = test::calibrated_rig();
  return {*calibration.camera, std::get<NearLights>(*calibration.lights)};
}

/// A sheet of reflectance 0.8 over the whole frame, by the simulator's law of light.
SheetEvidence sheet(const Rig& rig, const Pose& rig_from_sheet, double delta) {
  SheetEvidence evidence;
  evidence.columns = kColumns;
  evidence.rows = kRows;
  evidence.rig_from_sheet = rig_from_sheet;
  evidence.paper_delta = delta;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      SheetSquare square = {column, row, (column + 0.5) * kSquare_px, (row + 0.5) * kSquare_px, {}};
      const Vec3 point = *point_on_sheet(sight_of(rig.camera, square.x_px, square.y_px), rig_from_sheet);
      const Vec3 normal = normal_of(rig_from_sheet);
      for (const NearLight& led : rig.lights.leds) {
        const simulator::Incidence light = simulator::incidence(led, point);
        const double paper = 0.8 * (1 - delta * (1 - dot(normal, light.direction)));
        auto& reading = square.reading_rgb.emplace_back();
        for (std::size_t c = 0; c < 3; ++c)
          reading[c] = paper * simulator::shading(light, normal) * led.flux_rgb[c];
      }
      evidence.squares.push_back(square);
    }
  }
  return evidence;
}

Pose tilted(double tilt_deg) {
  return {rotation_of({0, radians(tilt_deg), 0}), {0, 0, 20}};
}

TEST(Flatness, OfAPerfectCalibrationIsPerfect) {
  const SheetCheck check = check_sheet(rig().camera, rig().lights, sheet(rig(), tilted(0), 0));
  EXPECT_EQ(check.squares, kColumns * kRows);
  EXPECT_LT(check.rms_deg, 1e-6);
  EXPECT_FALSE(check.slope_gain);
  EXPECT_NEAR(check.reflectance_rgb[1], 0.8, 1e-9);
}

TEST(Flatness, OfATiltedSheetHasASlopeGainOfOne) {
  for (const double delta : {0.0, 0.05}) {
    const SheetCheck check = check_sheet(rig().camera, rig().lights, sheet(rig(), tilted(20), delta));
    ASSERT_TRUE(check.slope_gain);
    EXPECT_NEAR(*check.slope_gain, 1, 1e-6);
    EXPECT_NEAR(check.tilt_deg, 20, 1e-9);
  }
}

TEST(Flatness, PaperThatIsNotLambertianCostsSlopeWhereItsTermIsUnknown) {
  SheetEvidence evidence = sheet(rig(), tilted(20), 0.05);
  evidence.paper_delta = 0;
  const SheetCheck check = check_sheet(rig().camera, rig().lights, evidence);
  EXPECT_GT(std::abs(*check.slope_gain - 1), 0.005) << *check.slope_gain;
}

TEST(Flatness, SeesALedThatIsBrighterThanCalibrated) {
  Rig moved = rig();
  for (double& flux : moved.lights.leds[4].flux_rgb) flux *= 1.02;
  const SheetCheck check = check_sheet(rig().camera, rig().lights, sheet(moved, tilted(0), 0));
  EXPECT_GT(check.rms_deg, 0.1);
  EXPECT_LT(check.rms_deg, 1);
}

TEST(Flatness, AKnownPlaneReplacesThePose) {
  SheetEvidence evidence = sheet(rig(), tilted(20), 0);
  evidence.known_normal = normal_of(tilted(21));
  const SheetCheck check = check_sheet(rig().camera, rig().lights, evidence);
  EXPECT_NEAR(*check.slope_gain, std::tan(radians(20)) / std::tan(radians(21)), 1e-6);
  EXPECT_NEAR(check.rms_deg, 1, 1e-6);
}

TEST(Flatness, SquaresWithFewerThanThreeLedsHaveNoNormal) {
  SheetEvidence evidence = sheet(rig(), tilted(0), 0);
  for (std::size_t k = 2; k < 10; ++k) evidence.squares[5].reading_rgb[k].fill(std::nan(""));
  const SheetCheck check = check_sheet(rig().camera, rig().lights, evidence);
  EXPECT_EQ(check.squares, kColumns * kRows - 1);
  EXPECT_TRUE(std::isnan(check.error_deg[5]));
}

}  // namespace
}  // namespace weft::calibration
