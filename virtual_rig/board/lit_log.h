// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <mutex>
#include <vector>

namespace weft::virtual_rig {

using RigClock = std::chrono::steady_clock;

/// Outputs of a board by their bits: LEDs 1 to 10, the light below the cloth, the polariser (on: crossed).
inline constexpr int kBelowBit = 10;
inline constexpr int kPolariserBit = 11;
inline constexpr int kOutputs = 12;

/// What the pins of a board did: the wire between the virtual board, which records, and the virtual camera,
/// which asks what an exposure gathered. Safe from any thread.
class LitLog {
 public:
  /// From `when` on the outputs of `mask` are on, bit 0 is LED 1. Times do not fall.
  void record(RigClock::time_point when, std::uint16_t mask);
  std::uint16_t now() const;
  /// Seconds between the two times that each of the first `outputs` was on. The last 1000 s are kept.
  std::vector<double> lit_seconds(RigClock::time_point from, RigClock::time_point to, int outputs) const;

 private:
  struct Edge {
    RigClock::time_point when;
    std::uint16_t mask;
  };
  mutable std::mutex mutex_;
  std::deque<Edge> edges_;
};

}  // namespace weft::virtual_rig
