// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>

namespace weft {

/// Whether two serial numbers of cameras are one: leading zeros do not count, since a body says its number
/// over USB with them and writes it into its files without, or the other way round. An empty one matches all.
inline bool same_serial(std::string_view a, std::string_view b) {
  const auto number = [](std::string_view text) {
    return text.substr(std::min(text.find_first_not_of('0'), text.size()));
  };
  return a.empty() || b.empty() || number(a) == number(b);
}

/// Whether two exposure times, f-numbers, ISO values or focal lengths are one setting: people, lenses, bodies
/// and files round them by a percent or so (1/60 s is 0.0166 s to one and 0.0167 s to another); a third of a
/// stop is 12 percent of an f-number and 26 of a time or an ISO value.
inline bool same_setting(double a, double b) {
  return std::abs(a - b) <= 0.02 * std::max(a, b);
}

}  // namespace weft
