// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/solve/left_out_facts.h"
#include "core/solve/verdict.h"
#include "report/page.h"
#include "solver/left_out/left_out.h"
#include "solver/method.h"

// What lights that were left out tell, in the forms that people read it in.

namespace weft::solve {

/// None where no reading was predicted. `numbers` are those of the lights.
std::optional<LeftOutFacts> facts_of(const solver::LeftOut& left_out, const std::vector<int>& numbers);

/// Lights are said not to fit from this median error, if it is over kOverNoise times what noise gives.
inline constexpr double kWorstFit = 0.1;
inline constexpr double kOverNoise = 3;

/// LIGHTS_DO_NOT_FIT, where they do not. The remedy names only levels above `level`, the one that ran.
std::optional<Verdict> verdict_of(const LeftOutFacts& facts, bool of_session,
                                  std::optional<solver::Level> level);

/// A section of report.html; empty of none. `noun` is LED or Light.
report::Section left_out_section(const std::optional<LeftOutFacts>& facts, const std::string& noun);

/// Lines for the terminal.
std::string left_out_words(const LeftOutFacts& facts);

}  // namespace weft::solve
