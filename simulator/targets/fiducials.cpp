// SPDX-License-Identifier: Apache-2.0
#include "simulator/targets/fiducials.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <opencv2/aruco.hpp>
#include <opencv2/aruco/charuco.hpp>
#include <utility>

namespace weft::simulator {
namespace {

using Dictionary = cv::Ptr<cv::aruco::Dictionary>;

constexpr std::array<std::pair<const char*, cv::aruco::PREDEFINED_DICTIONARY_NAME>, 21> kDictionaries = {{
    {"DICT_4X4_50", cv::aruco::DICT_4X4_50},
    {"DICT_4X4_100", cv::aruco::DICT_4X4_100},
    {"DICT_4X4_250", cv::aruco::DICT_4X4_250},
    {"DICT_4X4_1000", cv::aruco::DICT_4X4_1000},
    {"DICT_5X5_50", cv::aruco::DICT_5X5_50},
    {"DICT_5X5_100", cv::aruco::DICT_5X5_100},
    {"DICT_5X5_250", cv::aruco::DICT_5X5_250},
    {"DICT_5X5_1000", cv::aruco::DICT_5X5_1000},
    {"DICT_6X6_50", cv::aruco::DICT_6X6_50},
    {"DICT_6X6_100", cv::aruco::DICT_6X6_100},
    {"DICT_6X6_250", cv::aruco::DICT_6X6_250},
    {"DICT_6X6_1000", cv::aruco::DICT_6X6_1000},
    {"DICT_7X7_50", cv::aruco::DICT_7X7_50},
    {"DICT_7X7_100", cv::aruco::DICT_7X7_100},
    {"DICT_7X7_250", cv::aruco::DICT_7X7_250},
    {"DICT_7X7_1000", cv::aruco::DICT_7X7_1000},
    {"DICT_ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL},
    {"DICT_APRILTAG_16h5", cv::aruco::DICT_APRILTAG_16h5},
    {"DICT_APRILTAG_25h9", cv::aruco::DICT_APRILTAG_25h9},
    {"DICT_APRILTAG_36h10", cv::aruco::DICT_APRILTAG_36h10},
    {"DICT_APRILTAG_36h11", cv::aruco::DICT_APRILTAG_36h11},
}};

Result<Dictionary> dictionary_of(const std::string& name) {
  for (const auto& [known, number] : kDictionaries) {
    if (name == known) return cv::aruco::getPredefinedDictionary(number);
  }
  return Error{ErrorKind::kBadData, "OpenCV has no such dictionary of markers", "dictionary",
               fmt::format("\"{}\" is not one of its names", name),
               "use a name like DICT_5X5_100 or DICT_APRILTAG_36h11"};
}

Error too_few(const std::string& name, const cv::aruco::Dictionary& dictionary, std::string wanted) {
  return {ErrorKind::kBadData, "the dictionary has too few markers", "dictionary",
          fmt::format("{} has ids 0 to {}, and {} is wanted", name, dictionary.bytesList.rows - 1, wanted),
          "use a dictionary with more markers or ask for fewer"};
}

}  // namespace

Result<Marker> marker(const std::string& dictionary, int id) {
  const auto known = dictionary_of(dictionary);
  if (!known) return known.error();
  if (id < 0 || id >= (*known)->bytesList.rows) return too_few(dictionary, **known, fmt::format("{}", id));

  constexpr int kBorderCells = 1;
  Marker marker = {(*known)->markerSize + 2 * kBorderCells, {}};
  cv::Mat cells;
  (*known)->drawMarker(id, marker.side, cells, kBorderCells);  // a pixel a cell
  for (int row = 0; row < marker.side; ++row) {
    for (int column = 0; column < marker.side; ++column)
      marker.is_black.push_back(cells.at<unsigned char>(row, column) == 0);
  }
  return marker;
}

Result<std::vector<MarkerPlace>> charuco_markers(const std::string& dictionary, int squares_x,
                                                 int squares_y) {
  const auto known = dictionary_of(dictionary);
  if (!known) return known.error();
  const int markers = squares_x * squares_y / 2;
  if (markers > (*known)->bytesList.rows) return too_few(dictionary, **known, fmt::format("{}", markers - 1));

  const auto board = cv::aruco::CharucoBoard::create(squares_x, squares_y, 1.0F, 0.5F, *known);
  std::vector<MarkerPlace> places;
  for (std::size_t i = 0; i < board->ids.size(); ++i) {
    const cv::Point3f corner = board->objPoints[i][0];
    places.push_back(
        {board->ids[i], static_cast<int>(std::floor(corner.x)), static_cast<int>(std::floor(corner.y))});
  }
  return places;
}

}  // namespace weft::simulator
