// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "core/base/vec.h"

namespace weft::calibration {

/// A place in a picture: (0, 0) is the centre of the top left photosite of the active area.
struct PixelPoint {
  double x = 0, y = 0;
};

/// Where a body lies in a frame: a point p of the body is at  rotation p + translation_mm.
struct Pose {
  Mat3 rotation = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3 translation_mm;

  Vec3 operator()(Vec3 point_mm) const { return rotation * point_mm + translation_mm; }
};

inline Mat3 transposed(const Mat3& m) {
  return {{{m[0][0], m[1][0], m[2][0]}, {m[0][1], m[1][1], m[2][1]}, {m[0][2], m[1][2], m[2][2]}}};
}

inline Mat3 product(const Mat3& a, const Mat3& b) {
  Mat3 out = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) out[i][j] += a[i][k] * b[k][j];
    }
  }
  return out;
}

/// c_from_a of c_from_b and b_from_a.
inline Pose operator*(const Pose& c_from_b, const Pose& b_from_a) {
  return {product(c_from_b.rotation, b_from_a.rotation), c_from_b(b_from_a.translation_mm)};
}

inline Pose inverse(const Pose& pose) {
  const Mat3 back = transposed(pose.rotation);
  return {back, -1.0 * (back * pose.translation_mm)};
}

/// The rotation about the axis of `turn` by its length in radians (Rodrigues 1840).
inline Mat3 rotation_of(Vec3 turn) {
  const double angle = length(turn);
  if (angle == 0) return Pose().rotation;
  const Vec3 a = (1 / angle) * turn;
  const double s = std::sin(angle), c = std::cos(angle), v = 1 - c;
  return {{{c + v * a.x * a.x, v * a.x * a.y - s * a.z, v * a.x * a.z + s * a.y},
           {v * a.x * a.y + s * a.z, c + v * a.y * a.y, v * a.y * a.z - s * a.x},
           {v * a.x * a.z - s * a.y, v * a.y * a.z + s * a.x, c + v * a.z * a.z}}};
}

/// A pose a little off: turned by `turn` (radians) about the axes of the frame it is in, at the body's own
/// origin, and shifted. Covariances of poses are of these six numbers, turn first.
inline Pose moved(const Pose& pose, Vec3 turn, Vec3 shift_mm) {
  return {product(rotation_of(turn), pose.rotation), pose.translation_mm + shift_mm};
}

}  // namespace weft::calibration
