// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/cli/verb.h"

namespace weft::app {

/// The verbs of weft, in the order of its help.
std::vector<Verb> verbs();

// A file each.
Verb simulate_verb();
Verb solve_verb();
Verb compare_verb();
Verb calibrate_verb();
Verb rectify_verb();
Verb schema_verb();
Verb finish_verb();
Verb maps_verb();
Verb material_verb();
Verb export_verb();
Verb serve_verb();
Verb scan_verb();
Verb rig_verb();
Verb focus_verb();
Verb capture_verb();
Verb doctor_verb();
Verb copy_verb();
Verb library_verb();
Verb import_verb();
Verb batch_verb();
Verb demo_verb();
Verb torture_verb();

}  // namespace weft::app
