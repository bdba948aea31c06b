// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

#include "virtual_rig/board/lit_log.h"

namespace weft::virtual_rig::ptp {

/// A thread that does things when their time has come, one after the other. What has not begun when it ends
/// is not done.
class Timeline {
 public:
  Timeline() : thread_([this](const std::stop_token& stop) { run(stop); }) {}

  void at(RigClock::time_point when, std::function<void()> action);
  /// Waits for what it is doing.
  void stop();

 private:
  void run(const std::stop_token& stop);

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::multimap<RigClock::time_point, std::function<void()>> actions_;
  std::jthread thread_;  // last: ends before what it uses
};

}  // namespace weft::virtual_rig::ptp
