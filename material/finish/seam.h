// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "material/finish/tile.h"

namespace weft::material {

/// What can be seen of the joint along one axis of a finished tile. `repeat` pixels along that axis, 0: none.
Seam seam_of(const Tile& tile, const Overlap& overlap, const Cut& cut, int feather, double repeat_x,
             double repeat_y);

}  // namespace weft::material
