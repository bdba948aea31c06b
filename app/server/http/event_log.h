// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/json_document.h"

namespace weft::app {

/// What has happened on the rig, for clients that follow it. Safe from any thread.
class EventLog {
 public:
  struct Event {
    std::uint64_t number = 0;  ///< from 1
    std::string name;          ///< "status", "frame"
    std::string data;          ///< JSON on one line
  };

  EventLog();
  void add(const std::string& name, const Json& data);
  /// How things are: the last "status", under the number of the newest event. Its data are "{}" before the
  /// first.
  Event current() const;
  /// "BOOT.NUMBER": what a stream calls an event, unlike any of another daemon's.
  std::string id_of(const Event& event) const;
  /// The number in such an id, where all that followed is still held. Nothing for any other text.
  std::optional<std::uint64_t> number_of(std::string_view id) const;
  /// The events after this number that are still held (the last 512), oldest first; none after `timeout` or
  /// once closed.
  std::vector<Event> wait_after(std::uint64_t number, std::chrono::milliseconds timeout) const;
  /// Wakes all that wait, for good.
  void close();
  bool closed() const;

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable added_;
  std::deque<Event> events_;
  std::string status_ = "{}";
  const std::uint64_t boot_;
  std::uint64_t newest_ = 0;
  bool closed_ = false;
};

}  // namespace weft::app
