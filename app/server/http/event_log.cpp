// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/event_log.h"

#include <algorithm>

#include "app/server/http/error_json.h"

namespace weft::app {
namespace {

constexpr std::size_t kHeld = 512;

}  // namespace

// Milliseconds since 1970 pass faster than events come, so an id of an earlier daemon is always the smaller.
EventLog::EventLog()
    : newest_(static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::milliseconds>(
                                             std::chrono::system_clock::now().time_since_epoch())
                                             .count())) {}

void EventLog::add(const std::string& name, const Json& data) {
  std::string line = line_of(data);
  {
    const std::lock_guard lock(mutex_);
    if (name == "status") status_ = line;
    events_.push_back({++newest_, name, std::move(line)});
    if (events_.size() > kHeld) events_.pop_front();
  }
  added_.notify_all();
}

EventLog::Event EventLog::current() const {
  const std::lock_guard lock(mutex_);
  return {newest_, "status", status_};
}

std::vector<EventLog::Event> EventLog::wait_after(std::uint64_t id, std::chrono::milliseconds timeout) const {
  std::unique_lock lock(mutex_);
  added_.wait_for(lock, timeout, [&] { return closed_ || newest_ > id; });
  if (closed_) return {};
  const auto first = std::ranges::upper_bound(events_, id, {}, &Event::id);
  return {first, events_.end()};
}

void EventLog::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  added_.notify_all();
}

bool EventLog::closed() const {
  const std::lock_guard lock(mutex_);
  return closed_;
}

}  // namespace weft::app
