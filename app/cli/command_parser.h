// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/cli/verb.h"

namespace CLI {
class App;
}  // namespace CLI

namespace weft::app {

/// What a word of the command line runs.
struct RunOfVerb {
  const CLI::App* verb;
  Run run;
};

/// Adds verbs with their options, and those that every verb has. `runs` gets what each runs, and keeps alive
/// what its options are read into; so does the caller with `common`.
void add_verbs(CLI::App& parent, const std::vector<Verb>& verbs, CommonArguments& common,
               std::vector<RunOfVerb>& runs);

}  // namespace weft::app
