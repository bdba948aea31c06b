// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/raw_frame.h"
#include "solve/input/session_input.h"
#include "solve/photographs/photographs.h"

// What a session says of its own exposures, and what is made of it before it is solved (docs/conditions.md):
// pipeline/conditions does it, these say it. Each step changes the photographs, and adds to the conditions
// and the warnings of `loaded`.

namespace weft::app {

/// What a session has beyond the shots that are solved, in the order of the plan.
struct MoreFrames {
  pipeline::Frames repeats, parallel;
  std::vector<RawFrame> brackets;
};

/// Replaces the photosites that are hot, dead, or bad in the calibration's hot.png, in every frame.
Result<void> replace_bad_photosites(const SessionPlan& plan, const JobContext& context, LoadedSession& loaded,
                                    MoreFrames& more);

/// Puts bracket shots beside the lit shot of their LED, by measured ratios of light.
void join_brackets(const SessionPlan& plan, LoadedSession& loaded, MoreFrames& more);

/// Leaves out LEDs that are full on over 99 percent of the frame or did not light. kBadData where fewer than
/// three remain.
Result<void> leave_out_useless_lights(const SessionPlan& plan, LoadedSession& loaded);

/// Measures how bright each LED was in its shot, from white patches or a repeat shot, and gives the field's
/// lights that brightness.
Result<void> follow_drift(const SessionPlan& plan, const JobContext& context, LoadedSession& loaded,
                          MoreFrames& more);

/// Asks the cloth how bright each LED was (solve/conditions/led_gains.h), where no white patch has told,
/// and gives the field's lights that brightness where left-out light is predicted better for it.
Result<void> follow_cloth(const JobContext& context, LoadedSession& loaded);

}  // namespace weft::app
