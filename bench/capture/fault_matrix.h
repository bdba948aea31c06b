// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/base/study.h"
#include "core/base/result.h"

namespace weft::bench {

struct FaultMatrixOptions {
  std::filesystem::path programs;  ///< folder with weft, weft-camera and weft-virtual-rig
  std::filesystem::path scene;
  double megapixels = 0.2;
  int runs = 1000;
  int rigs = 16;                         ///< side by side
  std::uint64_t seed = 1;                ///< of shots and moments
  std::vector<std::string> faults = {};  ///< of fault_names(); empty: all
  std::filesystem::path keep = {};       ///< sessions and logs of runs that went wrong are kept here
  std::function<void(int done, int runs)> progress = [](int, int) {};
};

/// What may befall a scan: camera, board, light, and processes that are killed.
std::vector<std::string> fault_names();

/// How the runs of one fault ended.
struct FaultTally {
  std::string fault;
  int runs = 0;
  int complete = 0;      ///< by themselves, all frames right
  int resumed = 0;       ///< `weft scan` ended with a sentence; run again, it ended with all frames right
  int lost = 0;          ///< frames that are not there in the end
  int mislabelled = 0;   ///< frames that show another light than their name says
  int half_written = 0;  ///< files that are not what session.json says, or that it does not name
  int differing = 0;     ///< sessions whose record or calibration is not that of an undisturbed scan
  int silent = 0;        ///< ended without a sentence that says what to do, or not at all
  double most_s = 0;     ///< of a scan
  std::vector<std::string> wrong;  ///< what was wrong, a sentence a run
};

/// Scans the same cloth again and again, every fourth time with both states of the polariser and the light
/// below, half of the others metered, each time with one fault at a random shot
/// or moment (an earlier one, where the scan had ended by then), and compares every frame with an undisturbed
/// scan's, count by count: noise of these rigs depends on the light alone.
Result<std::vector<FaultTally>> fault_matrix(const FaultMatrixOptions& options);

/// A row a fault.
Rows rows_of(const std::vector<FaultTally>& tallies);

}  // namespace weft::bench
