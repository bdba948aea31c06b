// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/cli/verb.h"
#include "core/base/result.h"
#include "solve/run/solve_request.h"

namespace weft::app {

/// Prints what each level would give and cost, and which one the wishes choose.
Result<int> run_explain(const SolveRequest& arguments, const CommonArguments& common);

/// The level that the wishes choose, with a note of what is expected of it.
Result<LevelPrice> chosen_level(const SolveRequest& arguments, const CommonArguments& common);

/// Solves a session by every level and draws them side by side.
Result<int> run_ladder(const SolveRequest& arguments, const CommonArguments& common);

}  // namespace weft::app
