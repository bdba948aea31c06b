// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/cli/command_line.h"

namespace weft::app {

/// run_program for a program that holds all its verbs: Ceres keeps quiet in it, and `--manuals DIR` writes
/// its pages, completions and list of verbs, which the build installs.
int run_whole_program(const Program& program, int argc, char** argv);

}  // namespace weft::app
