// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"

// Markers and boards as OpenCV defines them (cv::aruco), in cells instead of pixels.

namespace weft::simulator {

/// The cells of a square marker, black border included, by rows from the top.
struct Marker {
  int side = 0;  ///< cells
  std::vector<bool> is_black;
};

/// kBadData if OpenCV has no such dictionary or the dictionary no such marker.
Result<Marker> marker(const std::string& dictionary, int id);

/// The square of a ChArUco board that holds a marker: columns from the left, rows from the top.
struct MarkerPlace {
  int id;
  int column;
  int row;
};

/// Where cv::aruco::CharucoBoard puts its markers. kBadData as above.
Result<std::vector<MarkerPlace>> charuco_markers(const std::string& dictionary, int squares_x, int squares_y);

}  // namespace weft::simulator
