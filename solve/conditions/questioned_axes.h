// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/solve/verdict.h"
#include "solve/photographs/photographs.h"
#include "solve/photographs/solve_plan.h"

namespace weft::solve {

/// LIGHTS_MIRRORED where the normals that photographs give are those of a surface once the lights' axes are
/// meant otherwise: mirrored, turned by a quarter or exchanged by the curl of the slopes, turned by half by
/// cast shadows or by how a masked thing falls away at its edge (solver/sanity/surface_witnesses.h).
std::optional<Verdict> doubt_axes(const Photographs& photographs, const SolvePlan& plan, int threads);

}  // namespace weft::solve
