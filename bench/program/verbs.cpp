// SPDX-License-Identifier: Apache-2.0
#include "bench/program/verbs.h"

namespace weft::bench {

std::vector<app::Verb> verbs() {
  return {solve_verb(),     effects_verb(), numerics_verb(), accuracy_verb(),
          explain_verb(),   photos_verb(),  height_verb(),   registration_verb(),
          transport_verb(), maps_verb(),    export_verb(),   calibration_verb(),
          capture_verb(),   server_verb(),  batch_verb(),    page_verb()};
}

}  // namespace weft::bench
