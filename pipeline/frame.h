// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/job.h"
#include "core/json_document.h"
#include "core/result.h"
#include "core/tiles.h"
#include "pipeline/bands.h"
#include "pipeline/photographs.h"
#include "solver/method.h"

namespace weft::app {

/// What solving a frame said of itself.
struct FrameFacts {
  double waited_seconds = 0;  ///< for the sink
  solver::SolveTally tally;
  Json reference = Json();  ///< of that level: {"stages", "rounds", "shadow_reach_is_capped"}
  Json gates = Json();      ///< of that level: see json_of(Gates)
};

/// Solves a frame by a level or method, whatever it extends over.
Result<FrameFacts> solve_frame(const Photographs& photographs, const solver::MethodName& method,
                               const TileOptions& tile, const JobContext& context, const BandSink& sink);

/// How many pixels were solved in which way, for solve.json.
Json json_of(const solver::SolveTally& tally);

/// Photographs of half the size for a quick look: each 2 x 2 cell of a mosaic is one pixel with a red, the
/// mean green and a blue reading, or the mean of four pixels of RGB. A reading of which any part cannot be
/// used is as unusable. An odd last row or column is left out.
Result<Photographs> half_size(const Photographs& photographs, int threads);

}  // namespace weft::app
