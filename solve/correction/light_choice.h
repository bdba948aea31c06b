// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "solve/correction/light_correction.h"
#include "solve/photographs/photographs.h"
#include "solver/left_out/left_out.h"

namespace weft::solve {

/// Which effects are taken out of the readings of a frame, and why.
struct LightChoice {
  LightStages stages;
  /// How much better left-out light is predicted with the effect than without it, the other one being as it
  /// was chosen. Without patches where it was not tried.
  solver::Gain shadows, interreflection;
  /// The scale of the albedo is relative, and the readings do not tell it: bounces stay in.
  bool scale_is_open = false;
};

/// Leaves lights out of solves by `method` on patches of at most four rows of blocks (solver/left_out) and
/// keeps each effect that `correction` traces where they are then predicted better by more than its own
/// sigma.
///
/// Both factors of a bounce carry the albedo's scale. Where it is relative, the scale is the one with which
/// left-out light is predicted best, mean albedos up to 1.4 being tried, and 2 to see that brighter cloth
/// does worse: so the same cloth is corrected alike whatever intensities the solve was given. Where brighter
/// cloth would always do better, it is open: that is so on shallow weaves, whose bounces look like a little
/// more albedo.
Result<LightChoice> choose_light(const Photographs& photographs, const solver::Method& method,
                                 const SolvedFrame& solved, LightCorrection& correction,
                                 const LightStages& traced, const JobContext& context);

/// How much better left-out light of corrected readings is predicted than of readings as they are, as errors
/// of equal brightness. What is subtracted makes readings darker, and what a model leaves of them, a
/// highlight say, with them: that predicts nothing better.
solver::Gain gain_of_correction(const solver::LeftOut& without, const solver::LeftOut& with);

/// How many patches choose_light() leaves lights out of in a frame of this size.
std::size_t light_choice_patches(Size size);

}  // namespace weft::solve
