// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/cli/verb.h"

namespace weft::app {

inline constexpr const char* kProgramName = "weft";
inline constexpr const char* kProgramHelp = "weft: photometric-stereo textile scanner";

/// A program that is told what to do by a verb.
struct Program {
  std::string name;  ///< as its help calls it
  std::string help;
  std::vector<Verb> verbs;
  std::string version = {};  ///< as --version prints it; empty: that of the sources
  std::string others = {};  ///< the program that runs verbs which have nothing to run here, by the same words
};

/// Reads the command line and runs the verb it names. Whatever goes wrong becomes words on standard error
/// and the exit code that is returned.
int run_program(Program program, int argc, char** argv);

}  // namespace weft::app
