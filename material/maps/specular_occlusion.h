// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace weft::material {

/// The share of a specular lobe that is seen through a visibility cone, as a table: 1 where the cone is the
/// whole sky, 0 where it is closed.
///
/// The lobe is what a GGX surface of roughness alpha sends around the mirror direction at normal view,
/// D(m) (m.n) / (4 m.v) with m half-way, and the cone stands about the bent normal (Jimenez, Wu, Pesce and
/// Jarabo 2016, section on specular occlusion; Chan 2018, 4.7, has a cone about the normal, and a view angle
/// in the place of the angle between the two). What counts is lobe inside the cone over lobe inside the
/// hemisphere about the bent normal, so that an open point loses nothing.
class SpecularOcclusion {
 public:
  static constexpr int kCones = 33;      ///< angles from 0 to 90 degrees, axis to edge
  static constexpr int kRoughness = 17;  ///< alpha from 0 to 1; 0 is taken as kLeastAlpha
  static constexpr int kAngles = 33;     ///< bent normal to mirror direction, from 0 to 90 degrees
  static constexpr double kLeastAlpha = 0.02;

  SpecularOcclusion();

  /// Between the table's nodes, each clamped to its range.
  double at(double cone_angle_deg, double alpha, double bent_to_mirror_deg) const;

  /// The table itself: cones fastest, then roughness, then angles.
  const std::vector<float>& values() const { return values_; }

 private:
  std::vector<float> values_;
};

}  // namespace weft::material
