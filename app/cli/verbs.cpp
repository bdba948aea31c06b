// SPDX-License-Identifier: Apache-2.0
#include "app/cli/verbs.h"

namespace weft::app {

std::vector<Verb> verbs() {
  return {simulate_verb(),
          solve_verb(),
          compare_verb(),
          calibrate_verb(),
          rectify_verb(),
          finish_verb(),
          maps_verb(),
          material_verb(),
          export_verb(),
          serve_verb(),
          scan_verb(),
          rig_verb(),
          focus_verb(),
          capture_verb(),
          doctor_verb(),
          copy_verb(),
          library_verb(),
          import_verb(),
          batch_verb(),
          demo_verb(),
          torture_verb(),
          schema_verb(),
          {.name = "bench", .help = "Measure", .program = "weft-bench"}};
}

}  // namespace weft::app
