// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "core/base/vec.h"
#include "simulator/camera/camera_settings.h"

namespace weft::simulator {

/// How the cloth lies in one shot: turned about the table's centre, then shifted, within its plane.
struct ClothMovement {
  double cosine = 1;
  double sine = 0;
  double x_mm = 0;
  double y_mm = 0;

  /// Where on the cloth, as it lies unmoved, a point of the rig is.
  Vec3 on_cloth(Vec3 point_mm) const {
    const double x = point_mm.x - x_mm, y = point_mm.y - y_mm;
    return {cosine * x + sine * y, cosine * y - sine * x, point_mm.z};
  }
  /// A direction of the unmoved cloth, such as a normal, as it lies in the rig.
  Vec3 turned(Vec3 direction) const {
    return {cosine * direction.x - sine * direction.y, sine * direction.x + cosine * direction.y,
            direction.z};
  }
};

/// Independent from shot to shot: the movement of a shot depends on settings, key and `shot` alone. Without
/// movement it is the unmoved cloth exactly.
ClothMovement movement_of_shot(const MovementSettings& settings, int shot, std::array<std::uint32_t, 2> key);

}  // namespace weft::simulator
