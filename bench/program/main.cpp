// SPDX-License-Identifier: Apache-2.0
// weft-bench: the program that `weft bench` runs.
#include "app/cli/whole_program.h"
#include "bench/program/studies.h"

int main(int argc, char** argv) {
  return weft::app::run_whole_program(
      {.name = "weft bench", .help = "Measure", .verbs = weft::bench::verbs()}, argc, argv);
}
