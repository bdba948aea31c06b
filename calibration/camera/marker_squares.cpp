// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/marker_squares.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>

#include "calibration/camera/dictionary.h"

namespace weft::calibration {

Result<std::vector<std::vector<bool>>> marker_squares(const std::string& name, int id) {
  const Result<cv::Ptr<cv::aruco::Dictionary>> dictionary = find_dictionary(name);
  if (!dictionary) return dictionary.error();
  const int markers = (*dictionary)->bytesList.rows, side = (*dictionary)->markerSize + 2;
  if (id < 0 || id >= markers) {
    return Error{ErrorKind::kUsage, "there is no such marker", fmt::format("{}, {}", name, id),
                 fmt::format("it has 0 to {}", markers - 1), "take one of these"};
  }
  cv::Mat picture;
  (*dictionary)->drawMarker(id, side, picture, 1);
  std::vector<std::vector<bool>> rows(static_cast<std::size_t>(side));
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x)
      rows[static_cast<std::size_t>(y)].push_back(picture.at<std::uint8_t>(y, x) == 0);
  }
  return rows;
}

}  // namespace weft::calibration
