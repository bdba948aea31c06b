// SPDX-License-Identifier: Apache-2.0
#include "core/rig/color_transform.h"

namespace weft {

Xyy affine_of(const std::array<double, 12>& map, const Xyy& color) {
  Xyy out = {};
  for (std::size_t i = 0; i < 3; ++i) {
    out[i] = map[4 * i] * color[0] + map[4 * i + 1] * color[1] + map[4 * i + 2] * color[2] + map[4 * i + 3];
  }
  return out;
}

Xyy cubic_of(const std::array<double, 12>& map, const Xyy& color) {
  Xyy out = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const double t = color[i];
    out[i] = map[4 * i] + t * (map[4 * i + 1] + t * (map[4 * i + 2] + t * map[4 * i + 3]));
  }
  return out;
}

Rgb rec709_of_camera(const ColorTransform& transform, const Rgb& camera) {
  if (!transform.curve) {
    const Vec3 rgb = transform.rec709_from_camera * Vec3{camera[0], camera[1], camera[2]};
    return {rgb.x, rgb.y, rgb.z};
  }
  const Xyy before = affine_of(transform.curve->before, xyy_of_xyz(xyz_of_rec709(camera)));
  const Xyy after = affine_of(transform.curve->after, cubic_of(transform.curve->cubic, before));
  return rec709_of_xyz(xyz_of_xyy(after));
}

}  // namespace weft
