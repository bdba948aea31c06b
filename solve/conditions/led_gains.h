// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "solve/conditions/conditions.h"
#include "solve/photographs/photographs.h"
#include "solver/left_out/left_out.h"

// How bright each light was against its calibration, told by the cloth itself.

namespace weft::solve {

/// The light of LED k on the readings is g_k times that of the calibration. With b = albedo times normal
/// eliminated at each sample pixel, what is left of its readings, P x = P diag(L b) log g, is linear in the
/// gains, P being the projection off the columns of L; they follow by least squares over the pixels,
/// Gauss-Newton, and a prior. A common gain shows in no residual, nor do gains that tilt a flat cloth: the
/// prior holds those. A trend of the gains with the height of their lights is given to the cloth, as the
/// diagnosis does: a sensor that is not linear and light between yarns look like one.
struct LedGains {
  std::vector<double> gain;   ///< by light
  std::vector<double> sigma;  ///< of each, with the prior and with how much quarters of the frame differ
  double misfit_before = 0;   ///< median chi-square a degree of freedom of the samples
  double misfit_after = 0;
  /// By how much left-out light is predicted better with the gains; none where it was not asked.
  std::optional<solver::Gain> left_out;

  bool is_kept() const { return left_out && left_out->keeps(); }
};

struct LedGainsOptions {
  double prior_sigma = 0.02;  ///< above 0; of a log gain: how far LEDs change between calibrations
  double most_gain = 0.06;    ///< beyond it a LED is faulty rather than changed, and none is corrected
  double most_misfit = 1.5;   ///< of misfit_after: cloth that no gains make Lambertian is not believed
  double least_sigmas = 5;    ///< that some gain must differ from 1 by, and by this share:
  double least_change = 0.01;
};

/// Nothing where the samples do not tell: no noise model, fewer than six lights, too few lit pixels, cloth
/// that is not Lambertian within its noise whatever the gains (gloss, light between yarns), gains that are
/// none or too large. Leaves lights out only where all that is passed. Samples do not depend on threads.
/// kInterrupted.
Result<std::optional<LedGains>> find_led_gains(const Photographs& photographs, const LedGainsOptions& options,
                                               const JobContext& context);

/// Asks the cloth where no white patch has told, and gives the field's lights the brightness where left-out
/// light is predicted better for it.
Result<void> follow_cloth(const Exposures& exposures);

}  // namespace weft::solve
