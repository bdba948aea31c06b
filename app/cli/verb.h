// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace weft::app {

class Options;

/// What every verb understands.
struct CommonArguments {
  bool json = false;    ///< one JSON document on standard output
  bool quiet = false;   ///< no progress
  int threads = 0;      ///< 0: all the machine has
  bool events = false;  ///< progress, notes and the end as lines of JSON on standard error
};

/// Runs a verb by what its options have read, prints its result, and returns the exit code of a success.
using Run = std::function<Result<int>(const CommonArguments&)>;

/// A word of the command line. One of the last three members says what follows it; where none does, another
/// program runs it (Program::others).
struct Verb {
  std::string name;
  std::string help;                   ///< its line in the list of verbs, and the top of its own help
  Run (*add)(Options& options) = {};  ///< adds its options, and keeps alive what they are read into
  std::vector<Verb> verbs = {};       ///< verbs of its own, one of which must be said
  std::string program = {};           ///< a program beside this one, which reads the rest and runs
  std::string group = {};             ///< the heading that the list of verbs has it under
  std::string old_name = {};          ///< does the same and is shown nowhere
};

}  // namespace weft::app
