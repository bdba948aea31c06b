// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/jobs/session_input.h"
#include "core/raw_frame.h"
#include "core/result.h"
#include "pipeline/photographs.h"

// What a session says of its own exposures, and what is made of it before it is solved (docs/conditions.md).
// Each step changes `photographs` and says so in its conditions and warnings.

namespace weft::app {

/// What a session has beyond the shots that are solved, in the order of the plan.
struct MoreFrames {
  std::vector<RawFrame> repeats;          ///< of mosaics
  std::vector<Image<float>> repeats_rgb;  ///< of RGB, as readings
  std::vector<RawFrame> brackets;         ///< of mosaics
};

/// Finds the photosites that are hot in the dark shot, dead in all lit ones or bad in the calibration's
/// hot.png, and gives them what their neighbours say, in every frame.
Result<void> replace_bad_photosites(const SessionPlan& plan, const JobContext& context,
                                    Photographs& photographs, MoreFrames& more);

/// Puts bracket shots beside the lit shot of their LED, by measured ratios of light.
void join_brackets(const SessionPlan& plan, Photographs& photographs, MoreFrames& more);

/// Leaves out LEDs that are full on over 99 percent of the frame or did not light. kBadData where fewer than
/// three remain.
Result<void> leave_out_useless_lights(const SessionPlan& plan, Photographs& photographs);

/// Measures how bright each LED was in its shot, from white patches or a repeat shot, and gives the field's
/// lights that brightness.
Result<void> follow_drift(const SessionPlan& plan, const JobContext& context, Photographs& photographs,
                          const MoreFrames& more);

}  // namespace weft::app
