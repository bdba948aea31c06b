// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "material/finish/tile.h"

namespace weft::material {

/// What can be seen of the joint along one axis of a finished tile. `before` is the cloth that was joined,
/// its first pixel the tile's. The first `skip` places across the axis are left out: another joint changed
/// them.
Seam seam_of(const Tile& tile, const Surface& before, const Overlap& overlap, const Cut& cut, int skip,
             const TilingOptions& options);

}  // namespace weft::material
