// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "solver/diagnosis/evidence_row.h"

namespace weft::solver {

/// What one light's photograph says when held against all the others.
struct LightEvidence {
  double residual_rms = 0;     ///< of (r / e - l . b) / rho over the usable readings
  double residual_median = 0;  ///< median absolute residual: highlights and shadows hardly count
  double residual_mean = 0;    ///< mean of the signed residual
  double gain = 1;             ///< r / (e l . b) from a fit without this light: median over pixels
  double gain_range = 0;       ///< of the gain, between four classes of how the cloth faces the light
  double saturated = 0;        ///< share of its readings that are saturated
  double shadowed = 0;         ///< share below the shadow mask, or marked
  double missing = 0;          ///< share that is missing
  double outlier = 0;          ///< share over five times the usual deviation
  double gradient = 0;         ///< change of the residual over the frame, if it were a plane
  double gradient_share = 0;   ///< share of the residual's variance that this plane explains
};

enum class FaultKind {
  kDead,       ///< the photograph shows no light
  kExchanged,  ///< photographs belong to other lights than they are named after
  kGain,       ///< the light gives `value` times what its calibration says
};

/// A fault that the readings name by themselves.
struct Fault {
  FaultKind kind = FaultKind::kDead;
  std::vector<std::size_t>
      lights;  ///< from 0; kExchanged: `lights[i]` shines in the photograph `shown_by[i]`
  std::vector<std::size_t> shown_by;
  double value = 0;            ///< kDead: share of the expected light seen; kGain: factor
  double sigma = 0;            ///< kGain: standard deviation of `value`
  double residual_before = 0;  ///< median over pixels of the mean deviation of these lights, over the albedo
  double residual_after = 0;   ///< residual_before with the fault corrected
  double moved_deg = 0;        ///< how far correcting it turns normals of least squares: median over pixels
  double agreement = 0;        ///< share of the parts of the picture that agree: 0 to 1
};

struct Diagnosis {
  std::size_t pixels = 0;  ///< that were bright and lit enough to be fitted
  double residual = 0;     ///< median over pixels of the mean deviation, over the albedo, as calibrated
  double left = 0;         ///< `residual` with all faults corrected
  std::vector<LightEvidence> lights;
  std::vector<Fault> faults;
};

/// Finds lights that do not do what their calibration says. Every pixel is fitted by least absolute
/// deviations without its shadowed readings; then, in this order,
/// - dead: the other lights predict light where the photograph has under 5 percent of it;
/// - exchanged: the best of all exchanges of two photographs, repeated (pairs among the ten worst lights
///   where there are more than twelve). It is named if the residual of the lights concerned falls below half
///   of what it was and below 0.12, and that of all K lights by a share of 1.5 / K;
/// - gain: a light that, predicted from the others, is off by over 1 percent, by over 5 standard deviations
///   (from the scatter of the other lights' gains, median absolute deviation) and by more than the gain
///   changes with the way the cloth faces the light (a highlight does, a LED does not), if correcting it
///   brings its residual below 0.6 of what it was and the whole is below 0.1.
/// What the cloth does to all lights of one zenith angle (no cloth is quite Lambert's) is taken for the
/// cloth: a factor exp(a + b l_z^2) is fitted along, so a ring of LEDs that fades as a whole is not named.
///
/// Needs six lights at least; with fewer, and where no pixel is bright enough, nothing is named. What
/// cannot be told from the readings alone, such as an exchange of two neighbours on a flat or glossy cloth,
/// is not named either. `threads` 0 is all the machine has; the result does not depend on them.
Diagnosis diagnose(const Evidence& evidence, int threads = 0);

}  // namespace weft::solver
