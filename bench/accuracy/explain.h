// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "bench/accuracy/scenes.h"
#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct ExplainOptions {
  SceneSet set = SceneSet::kHeldOut;
  std::uint32_t seed = 1;
  bool quick = false;  ///< one small patch a scene
  int threads = 0;
};

/// What `weft solve --explain` predicts, by `normal_deg` of sigma.exr, against what comes true: a row for
/// each scene and level, with the mean of both angles over all pixels with a solution, and their ratio. A
/// pixel of a preview is held against the four that it stands for.
Result<Rows> explain_table(const ExplainOptions& options);

}  // namespace weft::bench
