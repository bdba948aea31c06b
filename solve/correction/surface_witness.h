// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "solve/photographs/photographs.h"
#include "solver/left_out/block_choice.h"
#include "solver/method.h"

// The second witness of a choice: left-out light is blind to what all lights share, and prefers whatever
// takes up a misfit. The slopes of a surface have no curl, whatever light says.

namespace weft::solve {

/// What two ways to solve make of slopes where the better one was chosen, on the sample tiles.
struct CurlWitness {
  double base = 0, better = 0;            ///< rms of dp/dy - dq/dx, a pixel
  double bend_base = 0, bend_better = 0;  ///< rms of all four derivatives

  /// Whether the better one gives less of a surface: its curl is larger by kMostRise, and not as all of its
  /// slopes are a little steeper.
  bool objects() const;
};
inline constexpr double kMostRise = 0.03;

/// Readings are as they were taken. `choice`: where the better one stands.
CurlWitness ask_curl(const Photographs& photographs, const solver::Method& base, const solver::Method& better,
                     const solver::BlockChoice& choice, int threads);

/// A sentence for people: "left-out light ... with `what`, but ...".
std::string in_words(const CurlWitness& witness, const std::string& what);

}  // namespace weft::solve
