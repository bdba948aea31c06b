// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/board/lit_log.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace weft::virtual_rig {

void LitLog::record(RigClock::time_point when, std::uint16_t mask) {
  constexpr auto kKept = std::chrono::seconds(1000);
  const std::lock_guard lock(mutex_);
  if (!edges_.empty()) when = std::max(when, edges_.back().when);
  edges_.push_back({when, mask});
  while (edges_.size() > 1 && edges_[1].when < when - kKept) edges_.pop_front();
}

std::uint16_t LitLog::now() const {
  const std::lock_guard lock(mutex_);
  return edges_.empty() ? std::uint16_t{0} : edges_.back().mask;
}

std::vector<double> LitLog::lit_seconds(RigClock::time_point from, RigClock::time_point to,
                                        int outputs) const {
  std::vector<double> seconds(static_cast<std::size_t>(outputs), 0.0);
  const std::lock_guard lock(mutex_);
  // Exposures lie at the end of the log: back from there, until an edge before the exposure.
  auto end = to;
  for (auto edge = edges_.rbegin(); edge != edges_.rend() && end > from; ++edge) {
    const auto begin = std::max(edge->when, from);
    if (begin >= end) continue;
    const double lit = std::chrono::duration<double>(end - begin).count();
    for (std::size_t output = 0; output < seconds.size(); ++output) {
      if ((edge->mask >> output & 1) != 0) seconds[output] += lit;
    }
    end = begin;
  }
  return seconds;
}

}  // namespace weft::virtual_rig
