// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "solve/photographs/photographs.h"
#include "solver/registration/registration.h"

namespace weft::solve {

enum class ShiftVerdict {
  kStill,    ///< no shift that its error does not explain, or one that costs under kLeastCost_deg
  kLeftOut,  ///< the cloth lay elsewhere: the others are solved without this shot
  kFlagged,  ///< it stays in at its cost: without the shots that moved, too few would be left
};

struct ShotShift {
  solver::ShotRegistration measured;
  ShiftVerdict verdict = ShiftVerdict::kStill;
};

struct SessionShifts {
  std::vector<ShotShift> shots;  ///< by light of the field
  bool found = true;             ///< solver::Registration::found

  /// The lights with the verdict, in order.
  std::vector<std::size_t> with(ShiftVerdict verdict) const;
};

/// A shift that costs less is not worth a shot.
inline constexpr double kLeastCost_deg = 0.1;
/// So many shots stay at least, and more than have moved: four readings of three unknowns can still disagree.
inline constexpr std::size_t kLeastStillShots = 4;

/// Measures how the cloth lies in each shot on the sample tiles (solver/registration/registration.h) and
/// judges what to do about each. A moved shot is left out, not resampled: a mosaic has sites of one colour
/// two pixels apart, and a weave has detail finer than that, so resampling mends a fifth of what leaving out
/// does. Memory: a few megabytes. Returns kInterrupted on request.
Result<SessionShifts> register_shots(const Photographs& photographs, const JobContext& context);

/// Shifts beyond those that are registered.
struct MovedShots {
  std::vector<std::size_t> moved;  ///< lights whose shots show the cloth elsewhere; empty: nothing was found
  double most_px = 0;              ///< the largest shift, in pixels of the frame
  double explained = 0;            ///< solver::FarShifts::explained
  double reach_px = 0;             ///< no shift beyond it was looked for; 0: none was
};

/// Looks for shifts that are too large to be registered (solver/registration/far_shifts.h) in the middle of
/// the frame: 512 pixels a side, then 2048 and coarser. Memory: a copy of that part, which is smaller where
/// photographs are developed, so that it has at most 512 MB. None is looked for in more than 64 photographs.
/// Errors: kInterrupted, and those of cut().
Result<MovedShots> find_far_shifts(const Photographs& photographs, const JobContext& context);

}  // namespace weft::solve
