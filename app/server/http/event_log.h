// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "core/json_document.h"

namespace weft::app {

/// What has happened on the rig, for clients that follow it. Safe from any thread.
class EventLog {
 public:
  struct Event {
    std::uint64_t id = 0;  ///< rising, across restarts of the daemon too
    std::string name;      ///< "status", "frame"
    std::string data;      ///< JSON on one line
  };

  EventLog();
  void add(const std::string& name, const Json& data);
  /// How things are: the last "status", under the id of the newest event. Its data are "{}" before the first.
  Event current() const;
  /// The events after `id` that are still held (the last 512), oldest first; none after `timeout` or once
  /// closed.
  std::vector<Event> wait_after(std::uint64_t id, std::chrono::milliseconds timeout) const;
  /// Wakes all that wait, for good.
  void close();
  bool closed() const;

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable added_;
  std::deque<Event> events_;
  std::string status_ = "{}";
  std::uint64_t newest_;
  bool closed_ = false;
};

}  // namespace weft::app
