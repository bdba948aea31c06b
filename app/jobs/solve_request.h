// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/jobs/explain.h"
#include "app/jobs/solve.h"

namespace weft::app {

/// What `weft solve` is told: one of `session` and `photos` is named.
struct SolveArguments {
  SessionOptions session;
  PhotoOptions photos;
  SolveOptions options;
  bool explain = false;
  std::filesystem::path crops;  ///< where explain keeps what each level made of its cut; empty: nowhere
  LevelWish wish;
  std::filesystem::path ladder;  ///< a picture of all levels, instead of one solve
  std::vector<double> foretold;  ///< seconds, degrees and the share solved, of a price; empty: none
  std::string accept_moved;      ///< why to solve though the rig is known to have moved; empty: not
  bool check = false;            ///< print how well left-out lights are predicted
  bool strict = false;           ///< pixels without a solution, and warnings, end with exit code 2
};

}  // namespace weft::app
