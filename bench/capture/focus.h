// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct FocusOptions {
  std::filesystem::path scenes;  ///< folder of the example scenes
  int repeats = 20;              ///< photographs of each blur
  std::function<void(int done, int steps)> progress = [](int, int) {};
};

/// How well the focus score tells blur. A row a cloth and diameter of the disc that blurs it, in raw pixels:
/// "score" (mean of the repeats), "drop" (percent of the score in focus), "sigmas" (that drop over the
/// standard deviation of a photograph's score), and for two pixels across "just_told_px", the diameter whose
/// drop is one sigma, the score falling with its square. By one LED; the lens's own spread is in all of them.
/// Errors: those of read_scene().
Result<Rows> capture_focus_table(const FocusOptions& options);

}  // namespace weft::bench
