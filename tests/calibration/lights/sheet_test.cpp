// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/sheet.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::calibration {
namespace {

const CameraModel kCamera = overhead_camera({200, 100}, 500, 1);

TEST(Sheet, IsMetWhereItsHeightSays) {
  const Pose raised = {Pose().rotation, {0, 0, 100}};
  const auto point = point_on_sheet(sight_of(kCamera, 149.5, 49.5), raised);
  ASSERT_TRUE(point);
  EXPECT_NEAR(point->x, 50 * 0.8, 1e-9);  // a fifth of the way up to the camera
  EXPECT_NEAR(point->y, 0, 1e-9);
  EXPECT_NEAR(point->z, 100, 1e-9);
}

TEST(Sheet, IsNotSeenFromBehindNorFromBelow) {
  const Pose turned_over = {rotation_of({kPi, 0, 0}), {}};
  EXPECT_FALSE(point_on_sheet(sight_of(kCamera, 100, 50), turned_over));
  const Pose above_camera = {Pose().rotation, {0, 0, 600}};
  EXPECT_FALSE(point_on_sheet(sight_of(kCamera, 100, 50), above_camera));
}

TEST(Sheet, ShowsPaperInsideItsMarginAndBesideItsTags) {
  Sheet sheet = {100, 60, 10, {{20, 0, 8}}, {}};
  const auto shows = [&](double x_mm, double y_mm, double side) {
    return shows_paper(kCamera, sheet, {}, 99.5 + x_mm, 49.5 - y_mm, side);
  };
  EXPECT_TRUE(shows(0, 0, 4));
  EXPECT_TRUE(shows(37, 0, 4));
  EXPECT_FALSE(shows(39, 0, 4)) << "a corner of the block lies in the margin of 10 mm";
  EXPECT_FALSE(shows(0, 19, 4));
  EXPECT_FALSE(shows(20, 0, 4));
  EXPECT_FALSE(shows(15, 0, 4)) << "reaches into the tag that begins at 16 mm";
  EXPECT_TRUE(shows(13, 0, 4));
}

TEST(Sheet, OfTwoCapturesIsInOnePoseOnlyWhereAllOfItIs) {
  const Pose flat;
  EXPECT_TRUE(same_pose(flat, flat));
  EXPECT_TRUE(same_pose(flat, {rotation_of({0, 0, radians(1.5)}), {0.5, 0, 0}}));
  EXPECT_FALSE(same_pose(flat, {rotation_of({radians(1), 0, 0}), {}}));
  EXPECT_FALSE(same_pose(flat, {rotation_of({0, 0, radians(90)}), {}}))
      << "a turned sheet says something new";
  EXPECT_FALSE(same_pose(flat, {flat.rotation, {0, 0, 2}}));
}

}  // namespace
}  // namespace weft::calibration
