// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/job.h"
#include "core/base/result.h"
#include "core/image/tiles.h"
#include "solve/bands/bands.h"
#include "solve/correction/light_choice.h"
#include "solve/correction/light_correction.h"
#include "solve/gloss/gloss.h"
#include "solve/levels/work.h"
#include "solve/photographs/photographs.h"
#include "solver/gates/gates.h"
#include "solver/left_out/left_out.h"
#include "solver/method.h"

namespace weft::pipeline {

struct ReferenceOptions {
  int most_rounds = 4;
  /// Mean turn of the normals that a round is expected to make, below which that round is the last: as much
  /// less than the round before as that made less than the one before it.
  double settled_deg = 0.03;
  int directions = 12;                        ///< in which a pixel looks for light from the cloth
  int steps = 16;                             ///< as of solver::SliceSettings
  int early_directions = 6, early_steps = 8;  ///< before the last round
  int reach_px = 64;
  bool force_stages = false;  ///< whatever gates and left-out light say: for measurements
};

/// What one round did.
struct ReferenceRound {
  LightStages stages;     ///< taken out, by the relief of this round
  double turned_deg = 0;  ///< mean angle between the normals before and after; 0 of the last
  /// Turned the normals by no less than the round before: its normals are not used.
  bool is_refused = false;
  double slope_residual_rms = 0;  ///< how far the normals before were from any surface (solver/height)
  double height_seconds = 0, choice_seconds = 0, light_seconds = 0, solve_seconds = 0;
};

struct ReferenceFacts {
  solver::Gates gates;
  LightChoice choice;  ///< of the first round; of none where no gate is open or stages were forced
  LightStages stages;  ///< that the last solve took out
  std::vector<ReferenceRound> rounds;  ///< the last solve at their end, unless `robust` is published
  bool shadow_reach_is_capped = false;
  /// Left-out light by what the last round would give, over that by the level below; without patches where
  /// nothing was to be taken out.
  solver::Gain over_robust;
  bool robust_is_published = false;  ///< it predicts better: `stages` are none
  double robust_share = 1;           ///< of the frame; the rest is solved as the standard level does
  GlossFacts gloss;                  ///< of the readings that the last solve used
  /// Of the readings that the last solve used, on patches that chose nothing but between it and `robust`.
  solver::LeftOut left_out;
  solver::SolveTally tally;   ///< of the last solve
  double waited_seconds = 0;  ///< for the sink
  SolveWork work;             ///< but for what grows with the frame
};

/// The reference level: `robust`, then its normals integrated to a height, readings corrected for the shadows
/// and the light that this relief casts on itself (LightCorrection), and solved again, until they settle.
/// Gates (solver/gates) spare the work where nothing can be won; beyond them each effect is taken out only
/// where left-out light is predicted better without it (choose_light). A round that turns
/// the normals no less than the one before is refused: the last good one stands. As at the robust level,
/// blocks where `robust` predicts left-out light no better are solved as `standard` does. Pixels are solved
/// in double where their conditioning asks for it, as at any level. Without an effect there is but one solve.
///
/// What the last round would give is held against the level below on patches that chose nothing before. Where
/// that predicts left-out light better, by however little, its solution is the one that is published.
///
/// The lobe of a glossy cloth (solve/gloss/gloss.h) is found before the first round, so that relief and
/// bounces follow normals that highlights did not turn, and again for the last solve once bounces are out.
///
/// Relief and its light are taken in pixels and by the axes of the picture (picture_axes.h), so neither the
/// scale nor the camera's roll matters; it must look nearly straight down.
Result<ReferenceFacts> solve_reference(const Photographs& photographs, const TileOptions& tile,
                                       const ReferenceOptions& options, const JobContext& context,
                                       const BandSink& sink);

/// Bytes a pixel that solve_reference holds beside the photographs and the bands of any level: three solved
/// frames, two heights, and what integrating and tracing take (33 measured at 1.6 megapixels with ten
/// lights).
constexpr std::uint64_t reference_bytes_a_pixel(int planes) {
  return 3 * sizeof(float) * (3 + static_cast<std::uint64_t>(planes)) + 2 * sizeof(float) + 33;
}

}  // namespace weft::pipeline
