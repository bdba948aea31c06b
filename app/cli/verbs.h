// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/cli/arguments.h"
#include "core/result.h"

// One function a verb: runs it, prints its result, and returns the exit code of a success.

namespace weft::app {

Result<int> run_simulate(const SimulateArguments& arguments, const CommonArguments& common);
Result<int> run_solve(const SolveArguments& arguments, const CommonArguments& common);
Result<int> run_compare(const CompareArguments& arguments, const CommonArguments& common);
Result<int> run_bench_solve(const BenchSolveArguments& arguments, const CommonArguments& common);
Result<int> run_bench_effects(const BenchEffectsArguments& arguments, const CommonArguments& common);
Result<int> run_demo(const DemoArguments& arguments, const CommonArguments& common);

}  // namespace weft::app
