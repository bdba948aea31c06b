// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "solver/in_double/pixel.h"
#include "solver/method.h"

namespace weft::solver {

/// Rows of one pixel of a tile, in double, whatever a kernel would make of it.
void read_pixel(const TileInput& input, int x, int y, std::span<PixelRow> rows);

/// What a file can hold of a value: the largest float instead of infinity.
float finite(double value);

/// Writes what was solved into a tile, and counts it. Nothing leaves as infinity.
void write_pixel(const PixelSolution& solution, int planes, const TileOutput& output, int x, int y);

/// Solves every pixel of a tile by a function of its rows.
void solve_each_pixel(const TileInput& input, const TileOutput& output,
                      const std::function<PixelSolution(std::span<const PixelRow>)>& solve);

}  // namespace weft::solver
