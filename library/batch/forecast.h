// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "library/batch/plan.h"

// Which sessions are measured, and what the others are expected to give and cost by those that were.

namespace weft::library {

/// What is known of a session before it is opened.
struct SessionTraits {
  std::string fabric, calibration;
  std::string before;  ///< how it was solved so far: method, version and calibration; empty: not at all
  double megapixels = 0;
  int frames = 0;
};

/// Indices of at most `most` sessions, rising: as many of each class (cloth, calibration, size, frames, how
/// it was solved so far) as of any other, the larger classes first, spread evenly over the sessions of the
/// class.
std::vector<std::size_t> choose_sample(std::span<const SessionTraits> sessions, std::size_t most);

/// A session that was measured: a forecast a level, in an order that all share.
struct MeasuredSession {
  std::size_t session = 0;
  std::vector<Forecast> levels;
};

/// A forecast a level of every session: its own where it was measured, else the mean of those measured of the
/// narrowest class that has one: of its cloth, calibration, size and frames, of its cloth and size, of its
/// size, of all, where seconds go by pixels times frames. The spread is the standard deviation in the
/// narrowest class of two or more. An angle to the solve before is carried over only between sessions that
/// were solved alike so far. None where nothing was measured.
std::vector<std::vector<Forecast>> carry_over(std::span<const SessionTraits> sessions,
                                              std::span<const MeasuredSession> measured);

}  // namespace weft::library
