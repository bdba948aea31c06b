// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/job.h"
#include "core/result.h"
#include "pipeline/photographs.h"
#include "solver/registration/registration.h"

namespace weft::pipeline {

enum class ShiftVerdict {
  kStill,      ///< no shift that its error does not explain, or one that costs under kLeastCost_deg
  kCorrected,  ///< the shot is resampled
  kFlagged,    ///< a shift that is left alone, at its cost: resampling would not help
};

struct ShotShift {
  solver::ShotRegistration measured;
  ShiftVerdict verdict = ShiftVerdict::kStill;
};

struct SessionShifts {
  std::vector<ShotShift> shots;  ///< by light of the field
  bool found = true;             ///< solver::Registration::found
  /// For Photographs::shifts: by light, or nothing where nothing is corrected, so that not a byte changes.
  std::vector<solver::ClothShift> corrections;
};

/// A shift that costs less is not worth a resampling.
inline constexpr double kLeastCost_deg = 0.1;
/// Resampling must lower the residual of the fit by this share: it costs resolution, and a shift that is
/// there explains what the lights alone cannot.
inline constexpr double kLeastGain = 0.05;

/// Measures how the cloth lies in each shot on the sample tiles (solver/registration/registration.h), and
/// decides what to do: shots whose shift is significant and costs enough are corrected together, if the
/// residual of `fast` at the photosites of the tiles is smaller once they are resampled; else they are
/// flagged. Shifts that the photographs have already are not looked at. Memory: a few megabytes. Returns
/// kInterrupted on request.
Result<SessionShifts> register_shots(const Photographs& photographs, const JobContext& context);

}  // namespace weft::pipeline
