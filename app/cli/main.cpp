// SPDX-License-Identifier: Apache-2.0
#include "app/cli/command_line.h"
#include "app/cli/verbs.h"

int main(int argc, char** argv) {
  return weft::app::run_program({"weft", "weft: photometric-stereo textile scanner", weft::app::verbs()},
                                argc, argv);
}
