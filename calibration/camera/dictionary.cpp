// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/dictionary.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace weft::calibration {

Result<cv::Ptr<cv::aruco::Dictionary>> find_dictionary(const std::string& name) {
  static_assert(cv::aruco::DICT_4X4_50 == 0 && cv::aruco::DICT_APRILTAG_36h11 == 20);
  constexpr std::array kNames = {"DICT_4X4_50",        "DICT_4X4_100",        "DICT_4X4_250",
                                 "DICT_4X4_1000",      "DICT_5X5_50",         "DICT_5X5_100",
                                 "DICT_5X5_250",       "DICT_5X5_1000",       "DICT_6X6_50",
                                 "DICT_6X6_100",       "DICT_6X6_250",        "DICT_6X6_1000",
                                 "DICT_7X7_50",        "DICT_7X7_100",        "DICT_7X7_250",
                                 "DICT_7X7_1000",      "DICT_ARUCO_ORIGINAL", "DICT_APRILTAG_16h5",
                                 "DICT_APRILTAG_25h9", "DICT_APRILTAG_36h10", "DICT_APRILTAG_36h11"};
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found != kNames.end())
    return cv::aruco::getPredefinedDictionary(static_cast<int>(found - kNames.begin()));
  return Error{ErrorKind::kBadData, "OpenCV has no such dictionary of markers", "dictionary",
               fmt::format("\"{}\" is not one of its names", name),
               "use a name like DICT_5X5_100 or DICT_APRILTAG_36h11"};
}

}  // namespace weft::calibration
