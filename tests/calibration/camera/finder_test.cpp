// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/finder.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "core/image_io/encode_image.h"

namespace weft::calibration {
namespace {

constexpr Size kFrame = {3000, 2000};

Fiducial square_at(int id, double x_mm, double y_mm) {
  return {"DICT_APRILTAG_36h11",
          id,
          {Vec3{x_mm, y_mm, 0}, {x_mm + 20, y_mm, 0}, {x_mm + 20, y_mm - 20, 0}, {x_mm, y_mm - 20, 0}}};
}

/// As a picture of a fifth of the frame's width shows it, that much beside where it belongs.
TagSighting seen(const Fiducial& tag, const CameraModel& camera, Size picture, Vec3 shift_mm) {
  TagSighting sighting = {tag.dictionary, tag.id, {}};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 px = project(camera, tag.corners_mm[i] + shift_mm);
    const double scale = 1.0 * picture.width / camera.size.width;
    sighting.corners_px[i] = {(px.x + 0.5) * scale - 0.5, (px.y + 0.5) * scale - 0.5};
  }
  return sighting;
}

TEST(Finder, TellsHowFarTagsAreFromWhereTheyBelong) {
  const CameraModel camera = overhead_camera(kFrame, 600, 0.1);
  const std::vector<Fiducial> known = {square_at(1, -100, 60), square_at(2, 80, -40)};
  const Size picture = {600, 400};
  const std::vector<TagSighting> tags = {seen(known[0], camera, picture, {3, 4, 0}),
                                         seen(known[1], camera, picture, {3, 4, 0}),
                                         seen(square_at(7, 0, 0), camera, picture, {50, 0, 0})};
  const auto offsets = offsets_of(tags, picture, camera, known);
  ASSERT_TRUE(offsets);
  EXPECT_EQ(offsets->tags, 2) << "the third belongs nowhere";
  EXPECT_NEAR(offsets->rms_mm, 5, 1e-6);
  EXPECT_FALSE(offsets_of({tags.data() + 2, 1}, picture, camera, known));
}

TEST(Finder, OutlinesABoardClockwiseInSharesOfThePicture) {
  std::vector<BoardCorner> corners;
  for (const auto& [x, y] :
       {std::pair{99.5, 49.5}, {299.5, 49.5}, {299.5, 149.5}, {99.5, 149.5}, {199.5, 99.5}})
    corners.push_back({0, 0, {x, y}});
  const std::vector<PixelPoint> outline = outline_of(corners, {400, 200});
  ASSERT_EQ(outline.size(), 4U) << "the one in the middle is inside";
  double twice_area = 0;  // with y down, clockwise is positive
  for (std::size_t i = 0; i < 4; ++i) {
    const PixelPoint &a = outline[i], &b = outline[(i + 1) % 4];
    twice_area += a.x * b.y - b.x * a.y;
  }
  EXPECT_NEAR(twice_area / 2, 0.5 * 0.5, 1e-6);
}

TEST(Finder, IsEnlargedAndRefusesWhatIsNoPicture) {
  for (const auto& [width, times] : {std::pair{32, 4}, {306, 4}, {640, 2}, {1024, 2}, {1280, 1}, {1920, 1}}) {
    const std::vector<std::uint8_t> grey(24 * static_cast<std::size_t>(width), 90);
    const Result<std::string> jpeg = encode_image(grey, {width, 24}, 1, PictureFormat::kJpeg);
    ASSERT_TRUE(jpeg) << jpeg.error().message();
    const auto picture = finder_picture(*jpeg);
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->size(), (Size{times * width, times * 24})) << width;
    EXPECT_NEAR((*picture)(20, 20), 90, 2);
  }
  EXPECT_FALSE(finder_picture(""));
  EXPECT_FALSE(finder_picture("no picture"));
}

}  // namespace
}  // namespace weft::calibration
