// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct LevelSpeedOptions {
  double megapixels = 4;
  std::string scene;                 ///< this cloth alone, of any held out; empty: four of them
  std::vector<std::string> methods;  ///< these levels; empty: all from standard on
  int threads = 0;                   ///< 0: all the machine has
};

/// What levels take on whole frames in memory, of held-out cloths (bench/accuracy/scenes.h).
/// Rendering a megapixel takes up to a minute.
/// s: wall time of one solve, the search for a lobe in it, which is lobe_s. ns_per_pixel: of s.
/// ratio_to_unpack: of that to LibRaw's unpacking of four megapixels, as of accuracy_table(). said: of the
/// lobe. stages, rounds: of `reference`, what its last solve took out, and how often light was traced.
Result<Rows> level_speed(const LevelSpeedOptions& options);

}  // namespace weft::bench
