// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/image/image.h"

namespace weft::solver {

inline constexpr int kSampleTile = 128;

/// Sixteen tiles of 128 x 128 pixels, four by four over the frame at places that depend on its size alone:
/// what a cloth is measured on before it is worked on. They start on whole row groups and on whole cells of
/// the colour filter, lie inside the frame and never overlap. A frame too small for sixteen has fewer and
/// smaller ones.
std::vector<Rect> sample_tiles(Size size);

/// Columns and rows from one pixel to the next, so that at most so many pixels of the tiles are taken, or as
/// few as a step of a tile leaves. It is odd, and so meets all colours of the filter cell.
int sample_step(const std::vector<Rect>& tiles, std::size_t most_pixels);

}  // namespace weft::solver
