// SPDX-License-Identifier: Apache-2.0
#include "calibration/response/response_frames.h"

namespace weft::calibration {

double ResponseFrames::mean_black() const {
  double mean = 0;
  for (const auto& row : file_black) mean += static_cast<double>(row[0] + row[1]) / 4;
  return mean;
}

const std::vector<ExposureFrames>* ResponseFrames::of(const std::vector<int>& leds) const {
  const auto found = by_leds.find(leds);
  return found == by_leds.end() ? nullptr : &found->second;
}

}  // namespace weft::calibration
