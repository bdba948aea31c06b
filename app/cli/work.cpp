// SPDX-License-Identifier: Apache-2.0
// weft-work: what `weft` becomes for verbs that load what pictures need.
#include <utility>
#include <vector>

#include "app/cli/verbs.h"
#include "app/cli/whole_program.h"

int main(int argc, char** argv) {
  std::vector<weft::app::Verb> verbs = weft::app::work_verbs();
  verbs.push_back({.name = "bench", .help = "Measure", .program = "weft-bench", .group = "Try"});
  return weft::app::run_whole_program(
      {.name = weft::app::kProgramName, .help = weft::app::kProgramHelp, .verbs = std::move(verbs)}, argc,
      argv);
}
