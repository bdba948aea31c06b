// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image.h"
#include "material/surface.h"

namespace weft::material {

/// A copy of all maps within `part`, which lies in the surface. It is no tile.
Surface part_of(const Surface& surface, Rect part);

}  // namespace weft::material
