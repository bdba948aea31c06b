// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>

#include "capture/rig.h"

namespace weft::app {

/// Screens near the rig, whose light falls on the cloth: a page that follows the rig is black while it is
/// photographed, for light that changes is in no dark photograph. Safe from any thread.
class Screens {
 public:
  using Clock = std::chrono::steady_clock;
  /// Devices that are opened first take longer.
  static constexpr std::chrono::milliseconds kAnnounced{750};

  explicit Screens(const capture::Rig& rig) : rig_(rig) {}

  /// Whether the rig's screens go black at all.
  bool go_black() const { return rig_.daemon.is_screen_seen; }
  /// A page follows the rig, and still does.
  void follow() { followed_ = Clock::now(); }
  /// Until pages that follow have said for kAnnounced that they will be black, since a scan began.
  void wait_until_announced(Clock::time_point begun) const;
  /// Until pages that follow have had the time to become black.
  void wait_until_black() const;

 private:
  bool are_followed() const;

  const capture::Rig& rig_;
  std::atomic<Clock::time_point> followed_{};
};

}  // namespace weft::app
