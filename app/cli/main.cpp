// SPDX-License-Identifier: Apache-2.0
// weft: it runs light verbs, and becomes weft-work for all others.
#include <algorithm>
#include <string>
#include <string_view>

#include "app/cli/command_line.h"
#include "app/cli/commit.h"
#include "app/cli/verb_lines.h"
#include "app/cli/verbs.h"

namespace {

using weft::app::Verb;

std::vector<Verb> all_verbs() {
  const std::vector<Verb> light = weft::app::light_verbs();
  std::vector<Verb> all;
  for (const weft::app::VerbLine& line : weft::app::verb_lines()) {
    const auto here = std::ranges::find(light, std::string_view(line.name), &Verb::name);
    all.push_back(
        here != light.end()
            ? *here
            : Verb{.name = line.name, .help = line.help, .program = line.program, .group = line.group});
  }
  return all;
}

std::string version() {
  const std::string commit = weft::app::commit();
  return WEFT_VERSION + (commit.empty() ? "" : " (" + commit + ")");
}

}  // namespace

int main(int argc, char** argv) {
  return weft::app::run_program({.name = weft::app::kProgramName,
                                 .help = weft::app::kProgramHelp,
                                 .verbs = all_verbs(),
                                 .version = version(),
                                 .others = "weft-work"},
                                argc, argv);
}
