// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/cli/command_line.h"

namespace weft::app {

/// An option, or a word without a dash, as help shows it.
struct CommandOption {
  std::vector<std::string> names;  ///< "-o", "--output"; of a word without a dash its name alone
  bool is_positional = false;
  bool is_required = false;
  bool takes_value = false;
  bool takes_many = false;
  std::string value;                 ///< what its value is: "PATH", "INT"; empty for a flag
  std::vector<std::string> choices;  ///< the only values it takes; empty: others too
  std::string range;                 ///< "from 0 to 1024"
  std::string otherwise;             ///< its value where it is not given, where help says one
  std::string help;
};

/// A program or one of its verbs.
struct CommandWord {
  std::string name;
  std::string help;
  std::string program;  ///< as Verb::program
  std::vector<CommandOption> options;
  std::vector<CommandWord> verbs;
};

/// All that a program understands, as its parser has it; --help and --version are left out.
CommandWord tree_of(const Program& program);

/// verb_lines.cpp, which defines verb_lines() (verb_lines.h).
std::string verb_lines_source(const Program& program);

}  // namespace weft::app
