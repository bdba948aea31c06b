// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/image/compression.h"
#include "core/image/tiles.h"
#include "core/solve/solve.h"
#include "solve/bands/bands.h"
#include "solve/input/photo_input.h"
#include "solve/input/session_input.h"
#include "solve/levels/work.h"
#include "solve/report/solve_report.h"

namespace weft::solve {

struct SolveOptions {
  std::string method = "standard";  ///< a name of solver::method_names()
  std::filesystem::path output;     ///< empty: <session>/solve/<id>, or ./<photographs>-solve/<id>
  Compression compression = Compression::kNone;  ///< of EXR files
  TileOptions tile = kSolveTile;
  bool previews = true;
  bool deblur = true;        ///< undoes the spread of the lens where the calibration knows it
  bool registration = true;  ///< finds how the cloth lay in each shot
  /// A session of the same cloth as it lay otherwise (Session::pose), in which its lobe is sought too, by the
  /// levels that seek one: scanned with the same calibration, and films if there were any. Empty: none.
  std::filesystem::path second_pose = {};
  /// Id of the plan of a batch that asks for it: the solve then waits until it is accepted, or asked for
  /// without a plan (solve/session/current.h).
  std::string plan = {};
  std::optional<double> cloth_spread = {};  ///< share, as of SolvePlan::cloth_spread; none: nobody said it
  double spread_distance_mm = solver::ClothSpread().mean_mm;  ///< that the share goes, in the mean
  bool condition = false;        ///< also writes condition.exr (solve/files/condition_map.h)
  bool looks_at_blocks = false;  ///< SolveReport::blocks is wanted. No part of the id
  /// What was said of it before: solve.json keeps it beside what was taken. No part of the id.
  std::optional<SolvePrice> foretold = {};
};

/// How the cloth spreads light, as a person says.
std::optional<solver::ClothSpread> said_spread(const SolveOptions& options);

struct SolveSeconds {
  double read = 0, prepare = 0, solve = 0, write = 0, pictures = 0, report = 0, sync = 0, total = 0;
  double conditions = 0;  ///< in `read`: frames are questioned and mended
  SolveWork work;         ///< `solve` by what it grows with
};

/// What a solve left behind.
struct SolveReport {
  std::filesystem::path folder;
  bool was_there = false;  ///< a complete solve of the same inputs and options was found
  SolveFacts facts;
  ExpectedError expected;  ///< of this run: zero if was_there
  SolveSeconds seconds;    ///< of this run: zero if was_there
  /// What blocks of 64 x 64 pixels showed, row by row, of this run, where they are wanted.
  std::vector<solver::BlockFacts> blocks = {};
};

/// The id that solve_session() gives the solve of this plan.
std::string id_of_solve(const SolvePlan& plan, const SolveOptions& options);

/// Solves a session into its maps (docs/formats.md): normal.exr, albedo.exr, sigma.exr, residual.exr,
/// status.png, solve.json, previews, report.json and report.html, made aside and published whole.
Result<SolveReport> solve_session(const SessionOptions& input, const SolveOptions& options,
                                  const JobContext& context);

/// The same from photographs under distant lights.
Result<SolveReport> solve_photos(const PhotoOptions& input, const SolveOptions& options,
                                 const JobContext& context);

/// The same from photographs that are in memory, their shots registered: what solving them costs, for a price
/// (solve/run/explain.h). `options.output` is not empty.
Result<SolveReport> solve_loaded(Photographs photographs, const SolveOptions& options,
                                 const JobContext& context);

}  // namespace weft::solve
