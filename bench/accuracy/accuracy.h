// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/accuracy/accuracy_scenes.h"
#include "bench/base/study.h"
#include "core/base/result.h"

namespace weft::bench {

/// What is asked of a table. Each reads what concerns it.
struct AccuracyTableOptions {
  SceneSet set = SceneSet::kHeldOut;
  std::uint32_t seed = 1;
  bool quick = false;                                ///< one small patch a scene, no yardsticks
  std::string scene;                                 ///< this scene, case or cloth alone; empty: all
  std::vector<std::string> methods;                  ///< these and the oracle; empty: all
  double megapixels = 4;                             ///< of whole frames
  std::filesystem::path scenes = "testdata/scenes";  ///< from where the program runs
  int threads = 0;
};

/// The scenes of the set, or the one that is named. kUsage where there is none of that name.
Result<std::vector<AccuracyScene>> chosen_scenes(const AccuracyTableOptions& options);

/// The scene of the rows that are means over all scenes.
inline constexpr const char* kAllScenes = "all";

/// One row for each scene and contender, and for each contender one over all scenes, the mean of theirs:
/// mean_deg, p95_deg: angle to the true normal; a pixel without solution counts with the (0, 0, 1) it has.
/// ratio_to_bound: rms of the angle over the pixel's own Cramer-Rao bound for the lights it faces and sees.
/// ratio_to_oracle: of mean_deg.
/// albedo_mean_rel, albedo_bias_rel: |A - B| / B and (A - B) / B in the photosite's own colour.
/// leak: slope of (A - B) / B over the true openness.
/// left_out_rel: of a level, median of |error| / reading where each light is left out and predicted.
/// ns_per_pixel: wall time with `threads`, the least of five, but for lobe_s: seconds that looking for a lobe
/// takes, whatever the size. ratio_to_unpack, ratio_to_copy: of it to the
/// yardsticks (bench/base/yardsticks.h). pareto: nothing else is both quicker and closer.
/// kUsage where no scene or method has the given name.
Result<Rows> accuracy_table(const AccuracyTableOptions& options);

/// The levels and methods from 3 to all ten LEDs, as means over the scenes: which LEDs, and the columns
/// above. The LEDs of each count are those with the least bound of all choices (leds_by_bound).
Result<Rows> accuracy_by_leds(const AccuracyTableOptions& options);

/// The choice of `count` LEDs, numbered from 1, with the least mean square of the Cramer-Rao bound over a
/// green photosite of albedo 0.5 at the table's centre, level and tilted by 20 degrees to twelve sides.
Result<std::vector<int>> leds_by_bound(int count);

/// Who says SPECULAR: over 30 dark satins (three families, ten seeds) and 90 other cloths (the other five
/// materials, six seeds), of either set, small patches. A row for each method and group: how many there are,
/// how many have the bit on over 20 percent of pixels, and the least, median and largest share.
Result<Rows> specular_warnings(const AccuracyTableOptions& options);

// The others say in their files what their columns are.
Result<Rows> accuracy_bound(const AccuracyTableOptions& options);
Result<Rows> chain_table(const AccuracyTableOptions& options);
Result<Rows> accuracy_curves(const AccuracyTableOptions& options);
Result<Rows> accuracy_gates(const AccuracyTableOptions& options);
Result<Rows> explain_table(const AccuracyTableOptions& options);
Result<Rows> gloss_table(const AccuracyTableOptions& options);
Result<Rows> level_speed(const AccuracyTableOptions& options);
/// Prices whole sessions of these sizes.
Result<Rows> price_table(const AccuracyTableOptions& options, const std::vector<double>& megapixels);

}  // namespace weft::bench
