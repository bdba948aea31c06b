// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/base/result.h"
#include "exchange/textured_material.h"

namespace weft::exchange {

/// The rectangle that a document shows its material on.
struct ShownPlane {
  std::array<double, 2> size_m = {};
  std::array<int, 2> tiles = {1, 1};  ///< repeats along x and y
};

/// As large as the cloth that the tiles show. Where the size is not known a metre wide, with the proportions
/// of the base colour's pixels. kBadData: tiles outside 1 to 10000, or several of what does not repeat.
Result<ShownPlane> plane_of(const TexturedMaterial& material, std::array<int, 2> tiles);

}  // namespace weft::exchange
