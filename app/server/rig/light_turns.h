// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

namespace weft::app {

/// Which LED is lit while somebody looks for long: one after another, so that none gets warm.
class LightTurns {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kTurn{3};

  explicit LightTurns(int leds) : leds_(leds) {}

  /// The LED, from 1, whose turn it is now: the same one for kTurn while it may be lit for `least_s` more,
  /// then that of the others which may be lit longest. `can_light_s` is by LED; one that it lacks may not be
  /// lit.
  int turn(const std::vector<double>& can_light_s, double least_s, Time now) {
    const auto can = [&](int led) {
      const auto i = static_cast<std::size_t>(led) - 1;
      return i < can_light_s.size() ? can_light_s[i] : 0;
    };
    if (led_ > 0 && now < began_ + kTurn && can(led_) > least_s) return led_;
    // From the one that follows, so that those that are as cool as each other go round.
    int next = led_ % leds_ + 1;
    for (int i = 1; i < leds_; ++i) {
      const int other = (led_ + i) % leds_ + 1;
      if (other != led_ && can(other) > can(next)) next = other;
    }
    led_ = next;
    began_ = now;
    return led_;
  }

 private:
  int leds_;
  int led_ = 0;  ///< 0: none had a turn yet
  Time began_;   ///< its turn
};

}  // namespace weft::app
