// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "library/batch/plan.h"

// Which level each session is solved at.

namespace weft::library {

/// One level of one session. `seconds` is 0 where a solve of it is there, `degrees` are those of the whole
/// cloth (deg_of_whole).
struct LevelOption {
  double seconds = 0, degrees = 0;
};

/// Index of the cheapest option that is as close as `to_deg`; none where there is none.
std::optional<std::size_t> cheapest_within(std::span<const LevelOption> options, double to_deg);

struct Spending {
  std::vector<std::size_t> chosen;  ///< an option a session
  std::vector<Spent> curve;         ///< from the cheapest of all sessions to the best of all
};

/// Gives out seconds where each buys most degrees: every session begins with its cheapest option, then the
/// step of the largest gain a second is taken, session by session along the lower convex hull of its options
/// (Fox 1966, marginal allocation), until the next would not fit. That is the least mean error for the
/// seconds spent. kUsage where not even the cheapest of all fit.
Result<Spending> spend(std::span<const std::vector<LevelOption>> sessions, double seconds);

}  // namespace weft::library
