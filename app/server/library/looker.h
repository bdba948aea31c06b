// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>

namespace weft::app {

/// Looks at a disk on a thread of its own whenever somebody asks, so that a disk that is slow or hangs delays
/// nobody for longer than he wants to wait. Safe from any thread.
class Looker {
 public:
  using Clock = std::chrono::steady_clock;
  /// One look. Calls `beat` as it goes on: without a beat for kStuck the disk hangs. What it works on must
  /// outlive it: it is held by the function, never by the caller, who may be gone before a look that hangs.
  using Look = std::function<void(const std::stop_token& stop, const std::function<void()>& beat)>;
  static constexpr auto kStuck = std::chrono::seconds(3);

  /// Begins with a look. Another is not begun before the last one is as old as `fresh`, and twenty times as
  /// old as it took: looking takes at most a twentieth of a thread. Where `fresh` is 0 each question looks.
  Looker(Look look, Clock::duration fresh);
  /// Waits a second for a look to end; one that hangs is left to itself.
  ~Looker();
  Looker(const Looker&) = delete;
  Looker& operator=(const Looker&) = delete;

  /// What is known is old: the next question looks.
  void expire();
  /// Has it look again where that is due; the number of the look that tells how things are now.
  std::uint64_t ask();
  /// Waits until that look has ended, but not past `until`.
  void wait(std::uint64_t look, Clock::time_point until);
  /// Whether no look has ended yet.
  bool is_first() const;
  /// Whether the disk hangs.
  bool is_stuck() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
  std::stop_source stop_;
};

}  // namespace weft::app
