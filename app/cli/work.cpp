// SPDX-License-Identifier: Apache-2.0
// weft-work: what `weft` becomes for verbs that load what pictures need.
#include "app/cli/verbs.h"
#include "app/cli/whole_program.h"

int main(int argc, char** argv) {
  return weft::app::run_whole_program(
      {.name = weft::app::kProgramName, .help = weft::app::kProgramHelp, .verbs = weft::app::verbs()}, argc,
      argv);
}
