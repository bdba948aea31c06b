// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/image/tiles.h"
#include "solve/bands/bands.h"
#include "solve/bands/deblur.h"
#include "solve/correction/surface_witness.h"
#include "solve/gloss/gloss.h"
#include "solve/levels/reference.h"
#include "solve/levels/work.h"
#include "solve/photographs/photographs.h"
#include "solver/left_out/left_out.h"
#include "solver/method.h"

namespace weft::solve {

/// What solving a frame said.
struct FrameFacts {
  double waited_seconds = 0;  ///< seconds that bands waited for the sink
  SolveWork work;             ///< all other seconds
  solver::SolveTally tally;
  // By the stage that found it; none where it did not run.
  std::optional<DeblurFacts> deblur = {};  ///< sharpen
  /// realign: how much farther out red and blue look in the corner, pixels.
  std::optional<std::array<double, 2>> lateral_corner_px = {};
  /// blocks: the share of them on which `robust` predicts left-out light better than `standard`.
  std::optional<double> robust_share = {};
  std::optional<CurlWitness> against_robust = {};  ///< blocks: where curl overruled left-out light
  std::optional<GlossFacts> gloss = {};            ///< lobe: of the readings that were solved
  std::optional<ReferenceFacts> reference = {};    ///< gates and what follows them
  /// check, on patches that chose nothing; after a comparison on few rows of them (solve/correction).
  std::optional<solver::LeftOut> left_out = {};
  std::vector<solver::BlockFacts> blocks = {};  ///< of 64 x 64 pixels, row by row, where they are wanted
};

/// Solves a frame by the stages of a level or method (solve/levels/stages.h).
Result<FrameFacts> solve_frame(const Photographs& photographs, const solver::MethodName& method,
                               const TileOptions& tile, const JobContext& context, const BandSink& sink,
                               bool looks_at_blocks = false);

/// Photographs of half the size for a quick look: each 2 x 2 cell of a mosaic is one pixel with a red, the
/// mean green and a blue reading, or the mean of four pixels of RGB. A reading of which any part cannot be
/// used is as unusable. An odd last row or column is left out.
Result<Photographs> half_size(const Photographs& photographs, int threads);

}  // namespace weft::solve
