// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/aruco/dictionary.hpp>
#include <string>

#include "core/base/result.h"

namespace weft::calibration {

/// One of OpenCV's predefined dictionaries of markers by its name. kBadData if there is no such.
Result<cv::Ptr<cv::aruco::Dictionary>> find_dictionary(const std::string& name);

}  // namespace weft::calibration
