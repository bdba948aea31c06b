// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/markers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "bench/oracles/oracle_rig.h"
#include "tests/calibration/camera/frames.h"

namespace weft::test {
namespace {

using calibration::find_tags;
using calibration::grey_picture;
using calibration::PixelPoint;
using calibration::Pose;
using calibration::sheet_pose;
using calibration::SheetPose;
using calibration::SheetTag;
using calibration::TagSighting;
using testing::HasSubstr;

const std::string kTags = "DICT_APRILTAG_36h11";

/// Where the corners of a tag with a side of 1 are, upper left first, clockwise.
constexpr std::array<std::array<double, 2>, 4> kCorners = {
    {{-0.5, 0.5}, {0.5, 0.5}, {0.5, -0.5}, {-0.5, -0.5}}};

simulator::TargetSettings tag(int id, double side_mm, Vec3 centre_mm, double rotation_deg = 0,
                              double tilt_deg = 0) {
  simulator::TargetSettings settings;
  settings.pattern = simulator::TagSettings{.id = id, .side_mm = side_mm, .margin_mm = side_mm / 5};
  settings.centre_mm = centre_mm;
  settings.rotation_deg = rotation_deg;
  settings.tilt_deg = tilt_deg;
  settings.azimuth_deg = 70;
  return settings;
}

TEST(GreyPicture, KeepsAnEdgeOfAMosaicWhereItIs) {
  // Columns below 20 are dark; the pixel of column 20 is half covered. Red and blue see less than green.
  RawFrame frame;
  frame.counts = Image<std::uint16_t>({40, 24});
  frame.black = {{{100, 100}, {100, 100}}};
  frame.white = 16000;
  constexpr std::array<double, 3> kSeen = {0.5, 1, 0.7};
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 40; ++x) {
      const double light = x < 20 ? 0.1 : x == 20 ? 0.5 : 0.9;
      const double seen = kSeen[static_cast<std::size_t>(frame.cfa.channel_at(x, y))];
      frame.counts(x, y) = static_cast<std::uint16_t>(100 + 10000 * light * seen);
    }
  }
  const Image<std::uint8_t> grey = grey_picture(frame);
  for (int y = 0; y < 24; ++y) {
    double rise = 0, moment = 0;
    for (int x = 15; x < 26; ++x) {
      rise += grey(x + 1, y) - grey(x, y);
      moment += (grey(x + 1, y) - grey(x, y)) * (x + 0.5);
    }
    EXPECT_NEAR(moment / rise, 20, 0.02) << "row " << y;
    EXPECT_NEAR(grey(30, y), 240, 1);
    EXPECT_NEAR(grey(5, y), 240 / 9.0, 2);
  }
}

TEST(FindTags, PutsCornersWithinAFewHundredthsOfAPixelAndNotInwards) {
  std::vector<PixelPoint> differences;
  double inwards = 0, inwards_by_opencv = 0;
  for (int turn = 0; turn < 4; ++turn) {
    simulator::Scene scene = board_scene();
    scene.seed = turn + 1;
    for (int i = 0; i < 6; ++i) {
      scene.targets.push_back(tag(i, 24,
                                  {-60 + 60.0 * (i % 3) + 1.3 * turn, -30 + 60.0 * (i / 3) + 0.7 * turn, 0},
                                  23.0 * i + 11 * turn, 12));
    }
    const RawFrame frame = photographed(scene);
    const Image<std::uint8_t> grey = grey_picture(frame);
    const cv::Mat picture(grey.height(), grey.width(), CV_8UC1,
                          const_cast<std::uint8_t*>(grey.plane().row(0)),
                          static_cast<std::size_t>(grey.plane().stride()));
    const auto tags = find_tags(grey.plane(), kTags);
    ASSERT_TRUE(tags) << tags.error().message();
    ASSERT_EQ(tags->size(), 6U);
    for (std::size_t i = 0; i < 6; ++i) {
      const TagSighting& seen = (*tags)[i];
      ASSERT_EQ(seen.id, static_cast<int>(i));
      const PixelPoint centre = seen_at(scene, i, 0, 0);
      for (std::size_t k = 0; k < 4; ++k) {
        const PixelPoint truth = seen_at(scene, i, 24 * kCorners[k][0], 24 * kCorners[k][1]);
        const PixelPoint d = {seen.corners_px[k].x - truth.x, seen.corners_px[k].y - truth.y};
        differences.push_back(d);
        const double arm = std::hypot(centre.x - truth.x, centre.y - truth.y);
        inwards += (d.x * (centre.x - truth.x) + d.y * (centre.y - truth.y)) / arm;
        std::vector<cv::Point2f> theirs = {{static_cast<float>(truth.x), static_cast<float>(truth.y)}};
        cv::cornerSubPix(picture, theirs, {3, 3}, {-1, -1},
                         {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 40, 1e-3});
        inwards_by_opencv += ((static_cast<double>(theirs[0].x) - truth.x) * (centre.x - truth.x) +
                              (static_cast<double>(theirs[0].y) - truth.y) * (centre.y - truth.y)) /
                             arm;
      }
    }
  }
  const Offsets offsets = offsets_of(differences);
  EXPECT_NEAR(offsets.mean_x, 0, 0.015);
  EXPECT_NEAR(offsets.mean_y, 0, 0.015);
  EXPECT_NEAR(inwards / static_cast<double>(differences.size()), 0, 0.01);
  EXPECT_GT(inwards_by_opencv / static_cast<double>(differences.size()), 0.05) << "what lines are fitted for";
  EXPECT_LT(offsets.rms, 0.04);
}

TEST(FindTags, SeesNoneOnAnEmptyTableAndRefusesAStrangeDictionary) {
  const Image<std::uint8_t> grey = grey_picture(photographed(board_scene()));
  const auto none = find_tags(grey.plane(), kTags);
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->empty());
  const auto strange = find_tags(grey.plane(), "DICT_9X9_50");
  ASSERT_FALSE(strange);
  EXPECT_THAT(strange.error().message(), HasSubstr("DICT_9X9_50"));
}

/// Tags in the corners of a sheet.
std::vector<SheetTag> sheet_tags(double width_mm, double height_mm, double side_mm = 15) {
  std::vector<SheetTag> tags;
  for (int i = 0; i < 4; ++i) {
    tags.push_back(
        {kTags, i, side_mm, width_mm * (i % 2 == 0 ? -0.5 : 0.5), height_mm * (i < 2 ? 0.5 : -0.5)});
  }
  return tags;
}

CameraModel lens_camera() {
  CameraModel camera = overhead_camera({2464, 1632}, 600, 0.08);
  camera.k1 = -0.06;
  camera.k2 = 0.02;
  return camera;
}

/// What a camera sees of tags on a sheet in a pose, with noise.
std::vector<TagSighting> sightings(const CameraModel& camera, const std::vector<SheetTag>& tags,
                                   const Pose& pose, double sigma_px, Random& random) {
  std::vector<TagSighting> seen;
  for (const SheetTag& tag : tags) {
    TagSighting sighting = {tag.dictionary, tag.id, {}};
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 p = project(camera, pose({tag.centre_u_mm + tag.side_mm * kCorners[k][0],
                                           tag.centre_v_mm + tag.side_mm * kCorners[k][1], 0}));
      sighting.corners_px[k] = {p.x + sigma_px * random.normal(), p.y + sigma_px * random.normal()};
    }
    seen.push_back(sighting);
  }
  return seen;
}

TEST(SheetPose, IsExactWithoutNoise) {
  Random random(1);
  const CameraModel camera = lens_camera();
  const std::vector<SheetTag> tags = sheet_tags(120, 80);
  const Pose truth = {calibration::rotation_of({0.2, -0.3, 0.5}), {5, -7, 30}};
  const auto pose = sheet_pose(camera, sightings(camera, tags, truth, 0, random), tags, "sheet");
  ASSERT_TRUE(pose) << pose.error().message();
  EXPECT_LT(length(pose->rig_from_sheet.translation_mm - truth.translation_mm), 1e-6);
  for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    EXPECT_LT(angle_deg(pose->rig_from_sheet.rotation * axis, truth.rotation * axis), 1e-7);
  EXPECT_EQ(pose->tags, 4);
}

TEST(SheetPose, HasTheCovarianceThatItsErrorsShow) {
  Random random(7);
  const CameraModel camera = lens_camera();
  const std::vector<SheetTag> tags = sheet_tags(120, 80);
  const Pose truth = {calibration::rotation_of({0.25, 0.1, -0.2}), {2, 3, 10}};
  std::array<double, 6> squares = {};
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto pose = sheet_pose(camera, sightings(camera, tags, truth, 0.1, random), tags, "sheet");
    ASSERT_TRUE(pose) << pose.error().message();
    const Mat3 off =
        calibration::product(pose->rig_from_sheet.rotation, calibration::transposed(truth.rotation));
    const Vec3 shift = pose->rig_from_sheet.translation_mm - truth.translation_mm;
    const std::array<double, 6> error = {off[2][1], off[0][2], off[1][0], shift.x, shift.y, shift.z};
    for (std::size_t i = 0; i < 6; ++i) squares[i] += error[i] * error[i] / pose->covariance[7 * i] / kTrials;
  }
  // Student's t with 26 degrees of freedom has a variance of 1.08; 200 trials show it to 10 percent.
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(squares[i], 1.08, 0.35) << "parameter " << i;
}

TEST(SheetPose, NeedsTwoTagsOfTheSheet) {
  Random random(1);
  const CameraModel camera = lens_camera();
  const std::vector<SheetTag> tags = sheet_tags(120, 80);
  std::vector<TagSighting> seen = sightings(camera, tags, {{Pose().rotation}, {0, 0, 5}}, 0, random);
  seen.resize(1);
  seen.push_back(seen.front());
  seen.back().id = 77;
  const auto pose = sheet_pose(camera, seen, tags, "sheet 3");
  ASSERT_FALSE(pose);
  EXPECT_THAT(pose.error().message(), testing::AllOf(HasSubstr("sheet 3"), HasSubstr("1 of 4")));
}

TEST(SheetPose, RefusesTagsThatLieElsewhereOnTheSheet) {
  Random random(1);
  const CameraModel camera = lens_camera();
  std::vector<SheetTag> tags = sheet_tags(120, 80);
  const auto seen = sightings(camera, tags, {Pose().rotation, {0, 0, 5}}, 0.05, random);
  tags[2].centre_u_mm += 3;
  const auto pose = sheet_pose(camera, seen, tags, "sheet");
  ASSERT_FALSE(pose);
  EXPECT_THAT(pose.error().message(), HasSubstr("do not lie where the sheet has them"));
}

TEST(SheetPose, RefusesTwoPosesThatFitAlike) {
  // A small sheet far away, tilted: it can be tilted the other way with nearly the same outline.
  Random random(5);
  const CameraModel camera = overhead_camera({2464, 1632}, 2000, 0.3);
  const std::vector<SheetTag> tags = sheet_tags(20, 20, 6);
  const Pose truth = {calibration::rotation_of({0.3, 0, 0}), {0, 0, 0}};
  const auto pose = sheet_pose(camera, sightings(camera, tags, truth, 0.1, random), tags, "sheet");
  ASSERT_FALSE(pose) << "residual " << pose->residual_px;
  EXPECT_THAT(pose.error().message(), HasSubstr("two poses"));
}

TEST(SheetPose, OfARenderedSheetIsTrueWithinItsSigma) {
  simulator::Scene scene = board_scene();
  simulator::TargetSettings paper;
  paper.pattern = simulator::PaperSettings{150, 100};
  paper.centre_mm = {3, -2, 15};
  paper.tilt_deg = 15;
  paper.azimuth_deg = 30;
  paper.rotation_deg = 4;
  scene.targets.push_back(paper);
  const Pose truth = pose_of(paper);
  std::vector<SheetTag> tags;
  for (const SheetTag& each : sheet_tags(110, 62, 20)) {
    simulator::TargetSettings printed = paper;
    printed.pattern = simulator::TagSettings{.id = each.id, .side_mm = 20, .margin_mm = 4};
    printed.centre_mm = truth({each.centre_u_mm, each.centre_v_mm, 0.001});
    scene.targets.push_back(printed);
    tags.push_back(each);
  }
  const auto seen = find_tags(grey_picture(photographed(scene)).plane(), kTags);
  ASSERT_TRUE(seen);
  const auto pose = sheet_pose(camera_of(scene), *seen, tags, "sheet");
  ASSERT_TRUE(pose) << pose.error().message();
  EXPECT_LT(pose->residual_px, 0.08);
  const double tilt_sigma_deg = degrees(std::sqrt(pose->covariance[0] + pose->covariance[7]));
  const double shift_sigma_mm = std::sqrt(pose->covariance[21] + pose->covariance[28] + pose->covariance[35]);
  EXPECT_LT(angle_deg(pose->rig_from_sheet.rotation * Vec3{0, 0, 1}, truth.rotation * Vec3{0, 0, 1}),
            3 * tilt_sigma_deg);
  EXPECT_LT(length(pose->rig_from_sheet.translation_mm - truth.translation_mm), 3 * shift_sigma_mm);
  EXPECT_LT(tilt_sigma_deg, 0.1);
}

}  // namespace
}  // namespace weft::test
