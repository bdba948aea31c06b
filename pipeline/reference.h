// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/job.h"
#include "core/result.h"
#include "core/tiles.h"
#include "pipeline/bands.h"
#include "pipeline/light_correction.h"
#include "pipeline/photographs.h"
#include "solver/gates/gates.h"
#include "solver/method.h"

namespace weft::pipeline {

struct ReferenceOptions {
  int most_rounds = 4;
  double settled_deg = 0.03;  ///< mean turn of the normals in a round, below which one more round is the last
  int rays = 32;
  int reach_px = 64;
  bool force_stages = false;  ///< whatever the gates say: for measurements
};

/// What one round did.
struct ReferenceRound {
  double turned_deg = 0;  ///< mean angle between the normals before and after
  double height_seconds = 0, light_seconds = 0, solve_seconds = 0;
};

struct ReferenceFacts {
  solver::Gates gates;
  LightStages stages;
  std::vector<ReferenceRound> rounds;
  bool shadow_reach_is_capped = false;
  solver::SolveTally tally;   ///< of the last solve
  double waited_seconds = 0;  ///< for the sink
};

/// The reference level: `robust`, then, where the gates say that this cloth needs it, its normals
/// integrated to a height, readings corrected for the shadows and the light that this relief casts on itself
/// (LightCorrection), and solved again, until they settle. The last solve is in double, with the
/// factorisation that each pixel's conditioning asks for. Without an open gate it is the only one.
///
/// Relief and its light are taken in pixels, so no scale is needed; the camera must look straight down.
Result<ReferenceFacts> solve_reference(const Photographs& photographs, const TileOptions& tile,
                                       const ReferenceOptions& options, const JobContext& context,
                                       const BandSink& sink);

}  // namespace weft::pipeline
