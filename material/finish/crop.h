// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "material/surface.h"

namespace weft::material {

/// A part of a cloth, in millimetres from its left and from its upper border; a size of 0 is all that is
/// left.
struct CropOptions {
  double left_mm = 0, top_mm = 0, width_mm = 0, height_mm = 0;
};

/// What was cut out.
struct Cropped {
  Surface surface;
  Rect part_px;  ///< the nearest whole pixels
};

/// kUsage where the part is not in the cloth or has no pixel; of a tile the part is no tile.
Result<Cropped> crop(const Surface& surface, const CropOptions& options);

}  // namespace weft::material
