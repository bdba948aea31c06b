// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench/base/study.h"

namespace weft::bench {

/// Names of what is done to frames of a rig; the first is nothing.
std::vector<std::string> frame_faults();

struct FrameFaultOptions {
  std::string fault;   ///< one alone; empty: all
  bool lists = false;  ///< a row each draw, instead of a row each fault
};

/// Frames of ten cloths under a rig, some of which lie: room light that the dark shot lacks, a dark shot that
/// is lit, light that flickers along rows, frames that are others', turned, cut or covered, each as strong as
/// was drawn. Of those that turn normals by over 0.1 degrees or albedo by over 1 percent how many are named,
/// and what is left of it; and of frames without a fault how often one is told. `options.runs` draws a fault
/// from `options.seed` on, the cloths in turn.
Result<Rows> frame_faults_table(const FrameFaultOptions& asked, const StudyOptions& options);

}  // namespace weft::bench
