// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/screens.h"

#include <thread>

namespace weft::app {

bool Screens::are_followed() const {
  constexpr auto kFollows = std::chrono::seconds(2);  // a stream says several times a second that it does
  return go_black() && Clock::now() - followed_.load() <= kFollows;
}

void Screens::wait_until_announced(Clock::time_point begun) const {
  if (are_followed()) std::this_thread::sleep_until(begun + kAnnounced);
}

void Screens::wait_until_black() const {
  if (are_followed()) std::this_thread::sleep_for(std::chrono::milliseconds(rig_.daemon.page_dark_ms));
}

}  // namespace weft::app
