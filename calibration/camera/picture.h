// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "calibration/camera/pose.h"
#include "core/image/image.h"

// What the detectors share.

namespace weft::calibration {

/// The longest side of the picture that markers and boards are looked for in; corners are refined in the
/// whole.
inline constexpr int kSearchSide = 1640;

/// OpenCV's detectors are not asked about smaller pictures.
inline constexpr int kLeastSide = 32;

/// A header over the pixels of a view; OpenCV has no const one.
inline cv::Mat mat_of(View<const std::uint8_t> grey) {
  return {grey.height(), grey.width(), CV_8UC1, const_cast<std::uint8_t*>(grey.row(0)),
          static_cast<std::size_t>(grey.stride())};
}

/// A picture smaller by a whole number.
struct ReducedPicture {
  cv::Mat picture;
  int factor = 1;

  /// The same place in the whole picture.
  PixelPoint whole(cv::Point2f p) const {
    return {(static_cast<double>(p.x) + 0.5) * factor - 0.5, (static_cast<double>(p.y) + 0.5) * factor - 0.5};
  }
};

inline ReducedPicture reduced(View<const std::uint8_t> grey) {
  const int longest = std::max(grey.width(), grey.height());
  ReducedPicture out = {mat_of(grey), (longest + kSearchSide - 1) / kSearchSide};
  if (out.factor > 1) {
    cv::Mat small;
    const int whole_width = grey.width() / out.factor * out.factor;
    const int whole_height = grey.height() / out.factor * out.factor;
    cv::resize(out.picture({0, 0, whole_width, whole_height}), small,
               {whole_width / out.factor, whole_height / out.factor}, 0, 0, cv::INTER_AREA);
    out.picture = small;
  }
  return out;
}

inline bool is_inside(View<const std::uint8_t> grey, double x, double y, double margin_px) {
  return x >= margin_px && y >= margin_px && x <= grey.width() - 1 - margin_px &&
         y <= grey.height() - 1 - margin_px;
}

/// Between four pixels, bilinearly; (x, y) must be inside the picture.
inline double sample(View<const std::uint8_t> grey, double x, double y) {
  const int i = std::min(static_cast<int>(x), grey.width() - 2),
            j = std::min(static_cast<int>(y), grey.height() - 2);
  const double u = x - i, v = y - j;
  const std::uint8_t *above = grey.row(j) + i, *below = grey.row(j + 1) + i;
  return (1 - v) * ((1 - u) * above[0] + u * above[1]) + v * ((1 - u) * below[0] + u * below[1]);
}

inline double distance(PixelPoint a, PixelPoint b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

}  // namespace weft::calibration
