// SPDX-License-Identifier: Apache-2.0
// weft-bench: the program that `weft bench` runs.
#include "app/cli/command_line.h"
#include "bench/program/verbs.h"

int main(int argc, char** argv) {
  return weft::app::run_program({"weft bench", "Measure", weft::bench::verbs()}, argc, argv);
}
