// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/image/image.h"

// Where a solve is judged: blocks of the frame, and small patches in them.

namespace weft::solver {

/// Pixels a side of the blocks that stages are chosen for. They begin at the frame's corner.
inline constexpr int kBlock = 256;

struct BlockGrid {
  int columns = 0, rows = 0;
  std::size_t count() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};
BlockGrid blocks_of(Size size);

/// A few pixels of one block. `pixels.x0` is a multiple of kRowGroup.
struct Patch {
  Rect pixels;
  std::size_t block = 0;  ///< row * columns + column in the grid
};

/// Patches that choose a stage never report its error.
enum class PatchUse { kChoose, kReport };

/// Patches of one use, block by block: one row of pixels in every second cell of 64 x 64, as on a chessboard.
/// 32 pixels choose and 16 report: 1/256 and 1/512 of the frame. They depend on the frame's size alone. A
/// frame of one cell has none that report.
std::vector<Patch> patches_of(Size size, PatchUse use);

}  // namespace weft::solver
