// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/finder.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>

#include "calibration/camera/picture.h"
#include "core/image_io/grey_jpeg.h"

namespace weft::calibration {
namespace {

constexpr int kWide = 1280, kMostTimes = 4;

int times_larger(int width) {
  return std::clamp((kWide + width - 1) / width, 1, kMostTimes);
}

}  // namespace

std::optional<Image<std::uint8_t>> finder_picture(const std::string& jpeg) {
  std::optional<Image<std::uint8_t>> small = grey_of_jpeg(jpeg);
  if (!small) return std::nullopt;
  const int times = times_larger(small->width());
  Image<std::uint8_t> picture({times * small->width(), times * small->height()});
  cv::Mat large = mat_of(picture.plane());
  cv::resize(mat_of(small->plane()), large, large.size(), 0, 0, cv::INTER_CUBIC);
  return picture;
}

std::optional<TagOffsets> offsets_of(std::span<const TagSighting> tags, Size size, const CameraModel& camera,
                                     std::span<const Fiducial> fiducials) {
  TagOffsets offsets;
  double squares = 0;
  for (const TagSighting& tag : tags) {
    const auto fiducial = std::ranges::find_if(fiducials, [&](const Fiducial& each) {
      return each.id == tag.id && each.dictionary == tag.dictionary;
    });
    if (fiducial == fiducials.end()) continue;
    ++offsets.tags;
    for (std::size_t i = 0; i < tag.corners_px.size(); ++i) {
      const PixelPoint share = share_of(tag.corners_px[i], size);
      const Vec3 belongs = fiducial->corners_mm[i];
      const Vec3 seen = point_on_plane(camera, share.x * camera.size.width - 0.5,
                                       share.y * camera.size.height - 0.5, belongs.z);
      squares += dot(seen - belongs, seen - belongs);
    }
  }
  if (offsets.tags == 0) return std::nullopt;
  offsets.rms_mm = std::sqrt(squares / (4 * offsets.tags));
  return offsets;
}

std::vector<PixelPoint> outline_of(std::span<const BoardCorner> corners, Size size) {
  std::vector<cv::Point2f> points, hull;
  for (const BoardCorner& corner : corners)
    points.emplace_back(static_cast<float>(corner.px.x), static_cast<float>(corner.px.y));
  cv::convexHull(points, hull, /*clockwise=*/false);  // OpenCV says so of a y that rises
  std::vector<PixelPoint> outline;
  for (const cv::Point2f& p : hull) outline.push_back(share_of({p.x, p.y}, size));
  return outline;
}

}  // namespace weft::calibration
