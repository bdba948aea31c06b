// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/conditions.h"

#include <array>

#include "solve/conditions/bad_photosites.h"
#include "solve/conditions/brackets.h"
#include "solve/conditions/drift.h"
#include "solve/conditions/full_scale.h"
#include "solve/conditions/led_gains.h"
#include "solve/conditions/lens_glare.h"
#include "solve/conditions/questioned_dark.h"
#include "solve/conditions/questioned_frames.h"
#include "solve/conditions/questioned_lights.h"
#include "solve/conditions/tilted_cloth.h"
#include "solve/conditions/translucent_cloth.h"
#include "solve/conditions/useless_lights.h"

namespace weft::solve {
namespace {

// In the order in which they must be met: each is found in photographs that those before it have put right.
constexpr std::array kConditions = {find_full_scale, tell_veil,       mend_photosites, hide_unread_rows,
                                    question_dark,   question_lights, add_brackets,    drop_useless_lights,
                                    question_frames, follow_drift,    lay_level,       take_off_spread_light,
                                    follow_cloth};

}  // namespace

Result<void> meet_conditions(const Exposures& exposures) {
  for (const auto meet : kConditions) {
    if (Result<void> met = meet(exposures); !met) return met;
  }
  return {};
}

}  // namespace weft::solve
