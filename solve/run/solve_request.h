// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/describe/fields.h"
#include "solve/run/explain.h"
#include "solve/run/solve_session.h"

namespace weft::solve {

/// What `weft solve` and a job that solves are told: one of `session` and `photos` is named.
struct SolveRequest {
  SessionOptions session;
  PhotoOptions photos;
  SolveOptions options;
  std::string quality;  ///< a level; with `method` empty: standard
  std::string method;   ///< one that levels are compared with; empty: a level
  bool explain = false;
  std::filesystem::path crops;  ///< where explain keeps what each level made of its cut; empty: nowhere
  LevelWish wish;
  std::filesystem::path ladder;  ///< a picture of all levels, instead of one solve
  std::vector<double> foretold;  ///< seconds, degrees and the share solved, of a price; empty: none
  std::string accept_moved;      ///< why to solve though the rig is known to have moved; empty: not
  bool check = false;            ///< print how well left-out lights are predicted
  bool strict = false;           ///< pixels without a solution, and warnings, end with exit code 2

  const std::string& method_asked() const;
};
void describe(Fields& fields, SolveRequest& request);

/// A job that prices what a solve would take.
struct PriceRequest {
  SolveRequest solve;
};
void describe(Fields& fields, PriceRequest& request);

}  // namespace weft::solve
