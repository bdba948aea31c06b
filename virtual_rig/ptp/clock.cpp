// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/ptp/clock.h"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace weft::virtual_rig::ptp {
namespace {

std::string formatted(const ClockReading& reading, const char* format) {
  char text[32];
  return {text, std::strftime(text, sizeof text, format, &reading.time)};
}

double seconds_since_1970(std::chrono::system_clock::time_point when) {
  return std::chrono::duration<double>(when.time_since_epoch()).count();
}

}  // namespace

ClockReading read_clock(std::chrono::system_clock::time_point when, double offset_s) {
  const double milliseconds = std::floor((seconds_since_1970(when) + offset_s) * 1000);
  const auto whole = static_cast<std::int64_t>(milliseconds);
  const auto seconds = static_cast<std::time_t>(std::floor(milliseconds / 1000));
  ClockReading reading;
  localtime_r(&seconds, &reading.time);
  reading.milliseconds = static_cast<int>(whole - std::int64_t{seconds} * 1000);
  return reading;
}

std::string ptp_time(const ClockReading& reading) {
  return formatted(reading, "%Y%m%dT%H%M%S");
}

std::string exif_time(const ClockReading& reading) {
  return formatted(reading, "%Y:%m:%d %H:%M:%S");
}

std::optional<double> offset_when_set_to(std::string_view ptp_time) {
  if (ptp_time.size() < 15 || ptp_time[8] != 'T') return std::nullopt;
  const auto part = [ptp_time](std::size_t at, std::size_t digits) {
    int number = -1;
    const char* const end = ptp_time.data() + at + digits;
    return std::from_chars(ptp_time.data() + at, end, number).ptr == end ? number : -1;
  };
  std::tm time = {};
  time.tm_year = part(0, 4) - 1900;
  time.tm_mon = part(4, 2) - 1;
  time.tm_mday = part(6, 2);
  time.tm_hour = part(9, 2);
  time.tm_min = part(11, 2);
  time.tm_sec = part(13, 2);
  time.tm_isdst = -1;
  if (time.tm_year < 70 || time.tm_mon < 0 || time.tm_mday < 1 || time.tm_hour < 0 || time.tm_min < 0 ||
      time.tm_sec < 0)
    return std::nullopt;
  return static_cast<double>(std::mktime(&time)) - seconds_since_1970(std::chrono::system_clock::now());
}

}  // namespace weft::virtual_rig::ptp
