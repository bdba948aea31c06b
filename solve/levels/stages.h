// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "solve/levels/reference.h"
#include "solve/levels/stage.h"
#include "solver/method.h"

namespace weft::solve {

/// What a level or method is, in order, as docs/accuracy.md has it. A level begins with the method of its
/// name, robust and reference with standard. Lists of higher levels have more stages and no other order, so
/// that what is left of one without them is the level below.
std::vector<Stage> stages_of(const solver::MethodName& method, const ReferenceOptions& options = {});

/// Begins with a method alone.
Stage method_stage(const solver::MethodName& method);
/// These two take bands on their way out, the later one in a list first.
Stage sharpen_stage();
Stage realign_stage();
Stage blocks_stage();
Stage lobe_stage();
Stage check_stage();
Stage solve_stage();

/// Those of the level reference (reference.h).
Stage gates_stage();
Stage relief_stage(const ReferenceOptions& options);
Stage choice_stage();
Stage rounds_stage();
Stage second_lobe_stage();
Stage comparison_stage();
Stage correction_stage();

}  // namespace weft::solve
