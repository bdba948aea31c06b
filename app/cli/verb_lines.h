// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace weft::app {

/// A verb as the list in the help of `weft` has it.
struct VerbLine {
  const char* name;
  const char* help;
  const char* program;  ///< as Verb::program
  const char* group;    ///< likewise
};

/// All verbs of weft in the order of its help. The build writes it by `weft-work --manuals`, so that the
/// light program names verbs that it does not hold.
std::span<const VerbLine> verb_lines();

}  // namespace weft::app
