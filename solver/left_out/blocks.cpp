// SPDX-License-Identifier: Apache-2.0
#include "solver/left_out/blocks.h"

#include <algorithm>

namespace weft::solver {
namespace {

constexpr int kCell = kRowGroup;
constexpr int kChooseWidth = 32, kReportWidth = 16;
constexpr int kLeastWidth = 8;  // of what the frame's edge leaves of a patch
static_assert(kBlock % kCell == 0);

// The patch's row in its cell: another one in each cell near by, so that no weave is met at one phase only.
int row_in_cell(int column, int row) {
  return (11 * column + 23 * row) % kCell;
}

}  // namespace

BlockGrid blocks_of(Size size) {
  return {(size.width + kBlock - 1) / kBlock, (size.height + kBlock - 1) / kBlock};
}

std::vector<Patch> patches_of(Size size, PatchUse use) {
  constexpr int kCells = kBlock / kCell;
  const int width = use == PatchUse::kChoose ? kChooseWidth : kReportWidth;
  const BlockGrid grid = blocks_of(size);
  std::vector<Patch> patches;
  for (std::size_t block = 0; block < grid.count(); ++block) {
    const int first_column = static_cast<int>(block) % grid.columns * kCells;
    const int first_row = static_cast<int>(block) / grid.columns * kCells;
    for (int row = first_row; row < first_row + kCells; ++row) {
      for (int column = first_column; column < first_column + kCells; ++column) {
        if (((row + column) % 2 == 0) != (use == PatchUse::kChoose)) continue;
        const int x0 = column * kCell, y0 = row * kCell + row_in_cell(column, row);
        const int x1 = std::min(x0 + width, size.width);
        if (y0 < size.height && x1 - x0 >= kLeastWidth) patches.push_back({{x0, y0, x1, y0 + 1}, block});
      }
    }
  }
  return patches;
}

}  // namespace weft::solver
