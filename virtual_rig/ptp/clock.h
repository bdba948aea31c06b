// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <ctime>
#include <optional>
#include <string>
#include <string_view>

namespace weft::virtual_rig::ptp {

/// What a camera's clock shows: local time, as this machine's zone has it.
struct ClockReading {
  std::tm time = {};
  int milliseconds = 0;
};

/// `offset_s`: of the camera's clock to this machine's.
ClockReading read_clock(std::chrono::system_clock::time_point when, double offset_s);
std::string ptp_time(const ClockReading& reading);   ///< "20260131T235958"
std::string exif_time(const ClockReading& reading);  ///< "2026:01:31 23:59:58"
/// The offset of a clock that is set to this time now; nothing if it is no PTP time.
std::optional<double> offset_when_set_to(std::string_view ptp_time);

}  // namespace weft::virtual_rig::ptp
