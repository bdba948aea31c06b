// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/ptp/timeline.h"

#include <utility>

namespace weft::virtual_rig::ptp {

void Timeline::at(RigClock::time_point when, std::function<void()> action) {
  {
    const std::lock_guard lock(mutex_);
    actions_.emplace(when, std::move(action));
  }
  changed_.notify_one();
}

void Timeline::stop() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void Timeline::run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    if (actions_.empty()) {
      changed_.wait(lock, stop, [this] { return !actions_.empty(); });
      continue;
    }
    const RigClock::time_point due = actions_.begin()->first;
    if (RigClock::now() < due) {
      changed_.wait_until(lock, stop, due, [&] { return actions_.begin()->first < due; });
      continue;
    }
    const std::function<void()> action = std::move(actions_.extract(actions_.begin()).mapped());
    lock.unlock();
    action();
    lock.lock();
  }
}

}  // namespace weft::virtual_rig::ptp
