// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "core/base/job.h"
#include "core/base/result.h"
#include "core/image/tiles.h"
#include "solve/bands/bands.h"
#include "solve/bands/deblur.h"
#include "solve/gloss/gloss.h"
#include "solve/levels/reference.h"
#include "solve/levels/work.h"
#include "solve/photographs/photographs.h"
#include "solver/left_out/left_out.h"
#include "solver/method.h"

namespace weft::pipeline {

/// What solving a frame said.
struct FrameFacts {
  double waited_seconds = 0;  ///< seconds that bands waited for the sink
  SolveWork work;             ///< all other seconds
  solver::SolveTally tally;
  std::optional<ReferenceFacts> reference = {};  ///< where the level is reference
  /// Of `robust` and `reference`: the share of blocks on which `robust` predicts left-out light better than
  /// `standard`, which solves the others.
  std::optional<double> robust_share = {};
  std::optional<GlossFacts> gloss = {};  ///< of `robust` and `reference`
  /// On patches that chose nothing.
  std::optional<solver::LeftOut> left_out = {};
  std::optional<DeblurFacts> deblur = {};  ///< where the spread of the lens is known
  /// Where lateral colour was taken out: how much farther out red and blue look in the corner, pixels.
  std::optional<std::array<double, 2>> lateral_corner_px = {};
};

/// Solves a frame by a level or method, whatever it extends over. Maps of mosaics are aligned by
/// photographs.lateral, and all are sharpened by photographs.spread.
Result<FrameFacts> solve_frame(const Photographs& photographs, const solver::MethodName& method,
                               const TileOptions& tile, const JobContext& context, const BandSink& sink);

/// Photographs of half the size for a quick look: each 2 x 2 cell of a mosaic is one pixel with a red, the
/// mean green and a blue reading, or the mean of four pixels of RGB. A reading of which any part cannot be
/// used is as unusable. An odd last row or column is left out.
Result<Photographs> half_size(const Photographs& photographs, int threads);

}  // namespace weft::pipeline
