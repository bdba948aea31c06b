// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

namespace weft {

/// A vector of three doubles: millimetres for points of the rig frame, unit length for directions.
struct Vec3 {
  double x = 0, y = 0, z = 0;

  friend Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

inline double dot(Vec3 a, Vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3 a) {
  return std::hypot(a.x, a.y, a.z);
}
inline Vec3 normalized(Vec3 a) {
  return (1.0 / length(a)) * a;
}

inline constexpr double kPi = 3.14159265358979323846;
inline double radians(double degrees) {
  return degrees * (kPi / 180.0);
}
inline double degrees(double radians) {
  return radians * (180.0 / kPi);
}

/// Angle between two directions in degrees, by atan2(|a x b|, a.b): exact for small angles too, where
/// acos(a.b) of float32 normals has a floor of 0.03 degrees.
inline double angle_deg(Vec3 a, Vec3 b) {
  return degrees(std::atan2(length(cross(a, b)), dot(a, b)));
}

/// A 3 x 3 matrix by rows; columns of a rotation `b_from_a` are the axes of a seen in b.
using Mat3 = std::array<std::array<double, 3>, 3>;

inline Vec3 operator*(const Mat3& m, Vec3 v) {
  return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
          m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

}  // namespace weft
