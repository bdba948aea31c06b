// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/base/study.h"
#include "bench/oracles/simulated_cloth.h"
#include "core/base/result.h"

namespace weft::bench {

/// Names of what is done to frames of a rig; the first is nothing.
std::vector<std::string> frame_faults();

/// What became of frames with a fault.
struct FrameOutcome {
  std::string cloth, said;            ///< its name, where one was asked for; names of verdicts
  double turned_deg = 0, albedo = 0;  ///< by the fault: of the normals, rms; of the albedo, a share
  double left_deg = 0;                ///< after what was found was mended
  bool is_named = false, is_told = false;
};
/// As strong as the seed draws it. kUsage where there is no such fault.
Result<FrameOutcome> outcome_of_frames(const std::string& fault, const test::SimulatedCloth& cloth,
                                       std::uint32_t seed);

struct FrameFaultOptions {
  std::string fault;   ///< one alone; empty: all
  bool lists = false;  ///< a row each draw, instead of a row each fault
};

/// Frames of ten cloths under a rig that lie: room light that the dark shot lacks, a dark shot that
/// is lit, light that flickers along rows, frames that are others', turned, cut or covered, each as strong as
/// was drawn. Of those that turn normals by over 0.1 degrees or albedo by over 1 percent how many are named,
/// and what is left of it; and of frames without a fault how often one is told. `options.runs` draws a fault
/// from `options.seed` on, the cloths in turn.
Result<Rows> frame_faults_table(const FrameFaultOptions& asked, const StudyOptions& options);

}  // namespace weft::bench
