// SPDX-License-Identifier: Apache-2.0
#include "core/rig/lateral_color.h"

#include <cmath>

namespace weft {

std::array<double, 2> shift_at(const RadialShift& shift, const CameraModel& camera, double x, double y) {
  const double dx = x - camera.cx, dy = y - camera.cy;
  const double u = dx / camera.fx, v = dy / camera.fy;
  const double share = shift.scale + shift.cubic * (u * u + v * v);
  return {share * dx, share * dy};
}

double shift_at_corner(const RadialShift& shift, const CameraModel& camera) {
  const double x = camera.cx < (camera.size.width - 1) / 2.0 ? camera.size.width - 1 : 0;
  const double y = camera.cy < (camera.size.height - 1) / 2.0 ? camera.size.height - 1 : 0;
  const auto [dx, dy] = shift_at(shift, camera, x, y);
  const double outwards = (x - camera.cx) * dx + (y - camera.cy) * dy;
  return std::copysign(std::hypot(dx, dy), outwards);
}

}  // namespace weft
