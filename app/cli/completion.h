// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/cli/command_tree.h"

namespace weft::app {

// What a shell needs to complete verbs, options and the words they take, as a file that never starts weft.
// Where a value is not one of a few words, names of files are offered.
std::string bash_completion(const CommandWord& program);
std::string zsh_completion(const CommandWord& program);
std::string fish_completion(const CommandWord& program);

}  // namespace weft::app
