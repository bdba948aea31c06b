// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/cli/verb.h"

namespace weft::bench {

/// The verbs of `weft bench`, in the order of its help.
std::vector<app::Verb> verbs();

// A file each.
app::Verb solve_verb();
app::Verb effects_verb();
app::Verb numerics_verb();
app::Verb accuracy_verb();
app::Verb explain_verb();
app::Verb photos_verb();
app::Verb height_verb();
app::Verb maps_verb();
app::Verb export_verb();
app::Verb batch_verb();
app::Verb registration_verb();
app::Verb transport_verb();
app::Verb calibration_verb();
app::Verb capture_verb();
app::Verb server_verb();
app::Verb page_verb();

}  // namespace weft::bench
