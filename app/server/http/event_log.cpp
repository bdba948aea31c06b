// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/event_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "app/server/http/error_reply.h"

namespace weft::app {
namespace {

constexpr std::size_t kHeld = 512;

}  // namespace

EventLog::EventLog()
    : boot_(static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::milliseconds>(
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

std::string EventLog::id_of(const Event& event) const {
  return fmt::format("{}.{}", boot_, event.number);
}

std::optional<std::uint64_t> EventLog::number_of(std::string_view id) const {
  const std::string ours = fmt::format("{}.", boot_);
  if (!id.starts_with(ours)) return std::nullopt;
  id.remove_prefix(ours.size());
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), number);
  if (error != std::errc() || end != id.data() + id.size()) return std::nullopt;
  const std::lock_guard lock(mutex_);
  const bool next_is_held = number == newest_ || (!events_.empty() && number + 1 >= events_.front().number);
  if (number > newest_ || !next_is_held) return std::nullopt;
  return number;
}

std::vector<EventLog::Event> EventLog::wait_after(std::uint64_t number,
                                                  std::chrono::milliseconds timeout) const {
  std::unique_lock lock(mutex_);
  added_.wait_for(lock, timeout, [&] { return closed_ || newest_ > number; });
  if (closed_) return {};
  const auto first = std::ranges::upper_bound(events_, number, {}, &Event::number);
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
