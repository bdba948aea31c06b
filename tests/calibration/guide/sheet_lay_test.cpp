// SPDX-License-Identifier: Apache-2.0
// Sheets of known poses, against what a person was asked for.
#include "calibration/guide/sheet_lay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/rig/camera.h"

namespace weft::calibration {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr Size kFrame = {1500, 1000};
constexpr double kPixel_mm = 0.2, kWidth_mm = 180, kHeight_mm = 120;

constexpr WantedLay kFlat = {.name = "flat", .is_in_middle = true};
constexpr WantedLay kTurned = {.name = "turned", .is_turned = true};
constexpr WantedLay kLeftUp = {"left", 20, 0, "left edge", "", 9};
constexpr WantedLay kAnySide = {"plane", 15, 0, "", "", 8};

SheetAim aim_at(const WantedLay& wanted) {
  SheetAim aim;
  aim.sheet.sheet.width_mm = kWidth_mm;
  aim.sheet.sheet.height_mm = kHeight_mm;
  aim.camera = overhead_camera(kFrame, 600, kPixel_mm);
  aim.wanted = wanted;
  return aim;
}

/// Its normal leans by `tilt_deg` towards `azimuth_deg`, its lowest corner `height_mm` above the table.
Pose pose_of(double tilt_deg, double azimuth_deg, double turn_deg = 0, double height_mm = 0,
             double x_mm = 0) {
  const double a = radians(azimuth_deg), turn = radians(turn_deg);
  const Mat3 tilted = rotation_of(radians(tilt_deg) * Vec3{-std::sin(a), std::cos(a), 0});
  Pose pose = {product(tilted, rotation_of({0, 0, turn})), {x_mm, 0, 0}};
  pose.translation_mm.z = height_mm - lay_of(pose, aim_at(kFlat).sheet.sheet).lowest_mm;
  return pose;
}

std::string said(const WantedLay& wanted, const Pose& pose, std::vector<double> turns_deg = {}) {
  SheetAim aim = aim_at(wanted);
  aim.turns_deg = std::move(turns_deg);
  return departure_of(lay_of(pose, aim.sheet.sheet), aim);
}

TEST(SheetLay, IsThatOfItsPose) {
  const Sheet sheet = aim_at(kFlat).sheet.sheet;
  const SheetLay lay = lay_of({rotation_of({0, radians(20), 0}), {3, 4, 50}}, sheet);
  EXPECT_NEAR(angle_deg(lay.normal, {std::sin(radians(20)), 0, std::cos(radians(20))}), 0, 1e-9);
  EXPECT_NEAR(lay.lowest_mm, 50 - kWidth_mm / 2 * std::sin(radians(20)), 1e-9);
  EXPECT_NEAR(lay_of({rotation_of({0, 0, radians(-70)}), {}}, sheet).turn_deg, -70, 1e-9);
  EXPECT_NEAR(between_deg(170, -170), 20, 1e-9);
}

TEST(SheetLay, OfAFlatSheetIsFlatOnTheTableInTheMiddle) {
  EXPECT_THAT(said(kFlat, pose_of(0, 0)), IsEmpty());
  EXPECT_THAT(said(kFlat, pose_of(3.5, 70)), IsEmpty());
  EXPECT_THAT(said(kFlat, pose_of(6, 0)),
              HasSubstr("tilted by 6 degrees, its left edge raised: lay it flat"));
  EXPECT_THAT(said(kFlat, pose_of(14, 270)), HasSubstr("its upper edge raised"));
  EXPECT_THAT(said(kFlat, pose_of(0, 0, 0, 14)), IsEmpty());
  EXPECT_THAT(said(kFlat, pose_of(0, 0, 0, 32)), HasSubstr("32 mm above the table"));
  // The frame is 300 mm by 200 mm.
  EXPECT_THAT(said(kFlat, pose_of(0, 0, 0, 0, 39)), IsEmpty());
  EXPECT_THAT(said(kFlat, pose_of(0, 0, 0, 0, -43)), HasSubstr("43 mm from the middle"));
}

TEST(SheetLay, OfATurnedSheetIsTurnedToAllBefore) {
  EXPECT_THAT(said(kTurned, pose_of(0, 0)), IsEmpty()) << "nobody knows of any before";
  EXPECT_THAT(said(kTurned, pose_of(0, 0, 2), {0}),
              HasSubstr("lies turned as before: turn it by 90 degrees"));
  EXPECT_THAT(said(kTurned, pose_of(0, 0, 40), {0}), HasSubstr("turned by 40 degrees"));
  for (const double turn_deg : {90.0, -90.0, 180.0, 75.0})
    EXPECT_THAT(said(kTurned, pose_of(0, 0, turn_deg), {0}), IsEmpty()) << turn_deg;
  EXPECT_THAT(said(kTurned, pose_of(0, 0, -179), {0, 178}), HasSubstr("as before"));
  EXPECT_THAT(said(kTurned, pose_of(15, 0, 90), {0}), HasSubstr("lay it flat"));
}

TEST(SheetLay, OfATiltedSheetHasTheAskedEdgeRaised) {
  EXPECT_THAT(said(kLeftUp, pose_of(20, 0)), IsEmpty());
  EXPECT_THAT(said(kLeftUp, pose_of(13, 10)), IsEmpty());
  EXPECT_EQ(said(kLeftUp, pose_of(1, 0)), "the sheet lies flat: raise its left edge");
  EXPECT_EQ(said(kLeftUp, pose_of(20, 180)), "the sheet's right edge is raised: raise its left edge");
  EXPECT_EQ(said(kLeftUp, pose_of(38, 0)), "the sheet is tilted by 38 degrees: tilt it by 20");
  for (const double azimuth_deg : {0.0, 100.0, 200.0, 300.0})
    EXPECT_THAT(said(kAnySide, pose_of(17, azimuth_deg)), IsEmpty()) << azimuth_deg;
  EXPECT_EQ(said(kAnySide, pose_of(0.5, 0)), "the sheet lies flat: raise an edge");
  EXPECT_EQ(said(kAnySide, pose_of(30, 0)), "the sheet is tilted by 30 degrees: tilt it by 15");
}

// Whoever laid the board the other way round has a rig frame that is.
TEST(SheetLay, HasTheSidesOfThePictureHoweverTheRigFrameIsTurned) {
  SheetAim aim = aim_at(kLeftUp);
  const Mat3 half = rotation_of({0, 0, kPi});
  aim.camera.camera_from_rig_rotation = product(aim.camera.camera_from_rig_rotation, half);
  const auto turned = [&](double azimuth_deg) {
    return departure_of(lay_of(pose_of(20, azimuth_deg), aim.sheet.sheet), aim);
  };
  EXPECT_THAT(turned(180), IsEmpty());
  EXPECT_THAT(turned(0), HasSubstr("right edge is raised"));
}

TEST(SheetLay, IsDrawnWhereItIsAsked) {
  SheetAim aim = aim_at(kTurned);
  aim.turns_deg = {0};
  const std::array<PixelPoint, 4> turned = outline_of(aim);
  const auto side_mm = [&](const PixelPoint& a, const PixelPoint& b) {
    return kPixel_mm * std::hypot((a.x - b.x) * kFrame.width, (a.y - b.y) * kFrame.height);
  };
  EXPECT_NEAR(std::abs(turned[0].x - turned[2].x) * kFrame.width * kPixel_mm, kHeight_mm, 1e-6);
  EXPECT_NEAR(std::abs(turned[0].y - turned[2].y) * kFrame.height * kPixel_mm, kWidth_mm, 1e-6);
  EXPECT_NEAR(turned[0].x + turned[2].x, 1, 1e-3) << "about the middle";
  // The raised edge is nearer to the camera, the other one on the table.
  const std::array<PixelPoint, 4> tilted = outline_of(aim_at(kLeftUp));
  const double raised_mm = kWidth_mm * std::sin(radians(20));
  EXPECT_NEAR(side_mm(tilted[1], tilted[2]), kHeight_mm, 1e-6);
  EXPECT_NEAR(side_mm(tilted[0], tilted[3]), kHeight_mm * 600 / (600 - raised_mm), 1e-6);
}

}  // namespace
}  // namespace weft::calibration
