// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/vec.h"
#include "core/rig/lights.h"

namespace weft::simulator {

/// What a point gets from a light of flux 1.
struct Incidence {
  Vec3 direction;       ///< unit, from the point to the light
  double strength = 0;  ///< on a surface that faces the light: 1 / mm^2 for a LED
  double distance_mm = 0;
};

/// An imperfect Lambertian point source (Queau et al., JMIV 2018, section 2): strength
/// max(0, -l . aim)^mu / d^2. A LED is no point: nearer than 1 mm counts as 1 mm.
Incidence incidence(const NearLight& led, Vec3 point_mm);

/// What a surface with this normal reflects of it per albedo, in the convention without pi: strength
/// max(0, n . l).
inline double shading(const Incidence& light, Vec3 normal) {
  const double cosine = dot(normal, light.direction);
  return cosine > 0 ? light.strength * cosine : 0;
}

/// What stands for the cosine under a sphere of even radiance whose radius is `sine` times its distance: the
/// cosine itself while the whole sphere is above the surface's horizon, and a smooth way to 0 while it sets
/// (Snyder, "Area light sources for real-time graphics", Microsoft Research 1996). A point inside
/// the sphere counts as just outside it.
double sphere_cosine(double cosine, double sine);

}  // namespace weft::simulator
