// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/screens.h"

#include <thread>

namespace weft::app {

void Screens::wait_until_black() const {
  constexpr auto kFollows = std::chrono::seconds(2);  // a stream says several times a second that it does
  if (!go_black() || Clock::now() - followed_.load() > kFollows) return;
  std::this_thread::sleep_for(std::chrono::milliseconds(rig_.daemon.page_dark_ms));
}

}  // namespace weft::app
