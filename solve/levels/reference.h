// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "solve/correction/light_choice.h"
#include "solve/correction/light_correction.h"
#include "solver/gates/gates.h"
#include "solver/left_out/left_out.h"

namespace weft::solve {

struct ReferenceOptions {
  int most_rounds = 4;
  /// Mean turn of the normals that a round is expected to make, below which that round is the last: as much
  /// less than the round before as that made less than the one before it.
  double settled_deg = 0.03;
  int directions = 12;                        ///< in which a pixel looks for light from the cloth
  int steps = 16;                             ///< as of solver::SliceSettings
  int early_directions = 6, early_steps = 8;  ///< before the last round
  int reach_px = 64;
};

/// What one round did.
struct ReferenceRound {
  LightStages stages;     ///< taken out, by the relief of this round
  double turned_deg = 0;  ///< mean angle between the normals before and after; 0 of the last
  /// Turned the normals by no less than the round before: its normals are not used.
  bool is_refused = false;
  double slope_residual_rms = 0;  ///< how far the normals before were from any surface (solver/height)
};

/// What the stages of the level reference found, beside what every level says (FrameFacts).
struct ReferenceFacts {
  solver::Gates gates;
  LightChoice choice;                  ///< by the first relief; of none where no gate is open
  LightStages stages;                  ///< that the solve took out
  std::vector<ReferenceRound> rounds;  ///< the solve at their end, unless `robust` is published
  bool shadow_reach_is_capped = false;
  /// Left-out light by what the solve would give, over that by the level below; without patches where
  /// nothing was to be taken out.
  solver::Gain over_robust;
  bool robust_is_published = false;  ///< it predicts better: `stages` are none
};

// The stages of the level reference, after those of robust.
//
// `gates` (solver/gates) spare the work where nothing can be won. `relief` solves the frame and integrates
// its normals to a height; from then on readings are corrected for the shadows and the light that this
// relief casts on itself (LightCorrection). `choice` keeps each effect only where left-out light is predicted
// better without it (choose_light). `rounds` solve and integrate again, until normals settle. A round that
// turns the normals no less than the one before is refused: the last good one stands.
//
// The lobe of a glossy cloth (solve/gloss/gloss.h) is found before the first relief, so that relief and
// bounces follow normals that highlights did not turn, and again by `second lobe` once bounces are out.
//
// `comparison` holds what the solve would give against the level below, on patches that chose nothing before.
// Where that predicts left-out light better, by however little, its solution is the one that is published.
//
// Relief and its light are taken in pixels and by the axes of the picture (picture_axes.h), so neither the
// scale nor the camera's roll matters; it must look nearly straight down.

/// Bytes a pixel that the level holds beside the photographs and the bands of any level: three solved
/// frames, two heights, and what integrating and tracing take (33 measured at 1.6 megapixels with ten
/// lights).
constexpr std::uint64_t reference_bytes_a_pixel(int planes) {
  return 3 * sizeof(float) * (3 + static_cast<std::uint64_t>(planes)) + 2 * sizeof(float) + 33;
}

}  // namespace weft::solve
