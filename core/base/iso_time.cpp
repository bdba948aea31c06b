// SPDX-License-Identifier: Apache-2.0
#include "core/base/iso_time.h"

#include <fmt/chrono.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace weft {
namespace {

// Seconds east of Greenwich.
std::optional<double> seconds_of_zone(const std::string& zone) {
  if (zone.empty() || zone == "Z") return 0;
  char sign = 0;
  int hours = 0, minutes = 0;
  if (std::sscanf(zone.c_str(), "%c%2d:%2d", &sign, &hours, &minutes) != 3) return std::nullopt;
  if (sign != '+' && sign != '-') return std::nullopt;
  return (sign == '-' ? -1 : 1) * (hours * 3600.0 + minutes * 60.0);
}

}  // namespace

std::string iso_time(double since_1970_s) {
  const double whole_s = std::floor(since_1970_s);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(static_cast<std::time_t>(whole_s)),
                     static_cast<int>(1000 * (since_1970_s - whole_s)));
}

double seconds_since_1970() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::string iso_time_now() {
  return fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr)));
}

std::optional<double> seconds_of_iso_time(const std::string& text) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, read = 0;
  double second = 0;
  if (std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d:%lf%n", &year, &month, &day, &hour, &minute, &second,
                  &read) != 6)
    return std::nullopt;
  if (month < 1 || month > 12 || day < 1 || day > 31 || hour < 0 || hour > 24 || minute < 0 || minute > 59 ||
      !(second >= 0 && second < 61))
    return std::nullopt;
  const std::optional<double> east_s = seconds_of_zone(text.substr(static_cast<std::size_t>(read)));
  if (!east_s) return std::nullopt;
  std::tm utc = {};
  utc.tm_year = year - 1900;
  utc.tm_mon = month - 1;
  utc.tm_mday = day;
  utc.tm_hour = hour;
  utc.tm_min = minute;
  return static_cast<double>(::timegm(&utc)) + second - *east_s;
}

}  // namespace weft
