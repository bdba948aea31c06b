// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace weft::app {

/// How warm the LEDs were when the board was asked.
struct LampHeat {
  using Time = std::chrono::steady_clock::time_point;
  static constexpr double kMostLit_s = 40;  ///< of a LED at once, by its board

  std::vector<double> felt_s;  ///< by LED: how long it might be lit at once; empty: the board could not tell
  Time felt;                   ///< when that was

  /// How long each may be lit at once now, where these have been lit since: what is lit heats, what is dark
  /// cools, a second a second.
  std::vector<double> can_light_s(const std::vector<int>& lit, Time now) const {
    const double since_s = std::chrono::duration<double>(now - felt).count();
    std::vector<double> seconds = felt_s;
    for (std::size_t i = 0; i < seconds.size(); ++i) {
      const bool is_lit = std::ranges::count(lit, static_cast<int>(i) + 1) > 0;
      seconds[i] = std::clamp(seconds[i] + (is_lit ? -since_s : since_s), 0.0, kMostLit_s);
    }
    return seconds;
  }
};

}  // namespace weft::app
