// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/rig/light_field.h"
#include "solver/in_double/pixel.h"
#include "solver/kernels/row_task.h"
#include "solver/method.h"

namespace weft::solver {

/// Float copies of what a row kernel needs of each light, in place of what `rows` holds.
void write_row_lights(const LightField& field, std::vector<RowLight>& rows);

/// Solves a tile row by row. `row_kernel` returns whether it left pixels marked kSolveAgain: those are solved
/// by PixelSolver, with the same options.
void solve_rows(const TileInput& input, const TileOutput& output, const PixelOptions& options,
                bool (*row_kernel)(RowTask& task));

}  // namespace weft::solver
