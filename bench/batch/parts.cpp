// SPDX-License-Identifier: Apache-2.0
#include "bench/batch/parts.h"

namespace weft::bench {

std::span<const BatchPart> batch_parts() {
  static constexpr BatchPart kParts[] = {
      {"local", "sessions by a batch against one process that solves them in turn", batch_local},
      {"plan", "a plan of 10 000 sessions", batch_plan},
      {"merge", "a report of 10 000 results", batch_merge},
      {"kills", "a batch that is killed at random moments", batch_kills},
      {"rigs", "40 sessions by three rigs, one calibrated wrongly", batch_rigs},
      {"farm", "a million sessions on 100 nodes, simulated, and the simulation against 200 tasks here",
       batch_farm},
  };
  return kParts;
}

}  // namespace weft::bench
