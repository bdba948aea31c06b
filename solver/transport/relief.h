// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "core/image/image.h"

// The solved height of a cloth as light meets it. All of solver/transport works in pixels of the picture:
// x = column, y = -row and z = height over mm_per_pixel, axes as in the rig frame. The camera looks down from
// infinity and light is distant over the millimetres that relief reaches.

namespace weft::solver {

/// A height map that light can be followed over: all finite, its range known. Borrows the heights.
struct Relief {
  View<const float> height_mm;  ///< one sample a pixel, positive towards the camera
  double mm_per_pixel = 0;
  float lowest_mm = 0, highest_mm = 0;

  static constexpr int kMostSide_px = 1 << 24;  ///< whole numbers of float32
  /// Refuses (kBadData) a map without pixels or with a side over kMostSide_px, a height that is not finite, a
  /// pixel pitch that is not positive, and a range over kMostRange_px.
  static Result<Relief> of(View<const float> height_mm, double mm_per_pixel);

  /// z in pixels above the lowest point. Float32 keeps it to 1/4000 pixel within that range.
  static constexpr double kMostRange_px = 8192;
  float z_px(int x, int y) const {
    return static_cast<float>((static_cast<double>(height_mm(x, y)) - static_cast<double>(lowest_mm)) /
                              mm_per_pixel);
  }
  float top_px() const;  ///< z of the highest point
  Rect pixels() const { return {0, 0, height_mm.width(), height_mm.height()}; }
};

/// The unit normal of each pixel of a tile, planes X, Y and Z in the rig frame; (0, 0) is the tile's corner.
struct Normals {
  View<const float> x, y, z;
};

/// Light is followed to a pixel from this far above its height, so that float32 does not hide it behind the
/// cell that the pixel lies in. It moves the edge of a shadow towards what casts it by kLift / tan(elevation
/// of the light): 0.03 pixel at 28 degrees.
inline constexpr float kLift = 1.0f / 64;

}  // namespace weft::solver
