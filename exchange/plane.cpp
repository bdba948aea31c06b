// SPDX-License-Identifier: Apache-2.0
#include "exchange/plane.h"

#include <string>

namespace weft::exchange {

Result<ShownPlane> plane_of(const TexturedMaterial& material, std::array<int, 2> tiles) {
  const auto is_count = [](int count) { return count >= 1 && count <= 10000; };
  if (!is_count(tiles[0]) || !is_count(tiles[1])) {
    return Error{ErrorKind::kBadData, "the rectangle cannot be made", "tiles",
                 std::to_string(tiles[0]) + " x " + std::to_string(tiles[1]) + " is not within 1 and 10000",
                 "ask for fewer repeats, or at least one"};
  }
  if (!material.repeats && (tiles[0] > 1 || tiles[1] > 1)) {
    return Error{ErrorKind::kBadData, "the rectangle cannot be made", "tiles",
                 "the material does not repeat, so that its borders would show",
                 "make it a tile first (weft finish), or ask for one"};
  }
  if (material.size_mm) {
    return ShownPlane{{(*material.size_mm)[0] / 1000 * tiles[0], (*material.size_mm)[1] / 1000 * tiles[1]},
                      tiles};
  }
  const Size pixels = material.base_color.texture ? material.base_color.texture->size : Size{1, 1};
  const double proportion = static_cast<double>(pixels.height) / pixels.width;
  return ShownPlane{{1, proportion * tiles[1] / tiles[0]}, tiles};
}

}  // namespace weft::exchange
