// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/calibrated_levels.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "core/rig/dark_counts.h"

namespace weft::calibration {

Result<void> check_levels(const RawFrame& frame, const Response& response,
                          const std::filesystem::path& file) {
  constexpr double kSameRange = 0.005;  // relative
  if (!response.levels) return {};
  const double black = mean_black(frame);
  const auto& blacks = response.levels->black;
  const double measured_black = std::accumulate(blacks.begin(), blacks.end(), 0.0) / 4;
  const double range = static_cast<double>(frame.white) - black;
  const double measured_range = response.levels->white - measured_black;
  if (std::abs(range / measured_range - 1) <= kSameRange) return {};
  return Error{
      ErrorKind::kBadData, "its levels are not those of the calibration", file.string(),
      fmt::format("it calls {:.0f} black and {:.0f} white, and the raws that the response was "
                  "measured on say {:.0f} and {:.0f}",
                  black, frame.white, measured_black, response.levels->white),
      "use raws as they come from the camera in all calibrations, or measure the response by raws as "
      "these"};
}

}  // namespace weft::calibration
