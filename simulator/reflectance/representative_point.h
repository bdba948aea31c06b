// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/vec.h"
#include "core/image/color_spaces.h"

// GGX under a light that is a ball instead of a point. docs/reflectance.md has the error of each way.

namespace weft::simulator {

/// The roughness that makes a point at its centre of a light of this radius: a GgxLobe of it reflects what
/// the lobe of `alpha` does under the ball. Half-vectors turn half as far as the light, and averaging D of
/// GGX over a disk of slopes adds the squares: sqrt(alpha^2 + (radius / (2 distance))^2), exact above the
/// mirrored view while both are small. Karis 2013 (seed 002) eq. 10 has alpha + radius / (3 distance) in its
/// place.
double widened_alpha(double alpha, double radius_mm, double distance_mm);

/// A ball that shines evenly, in the surface's own frame.
struct SphericalLight {
  Vec3 centre_mm;  ///< not unit
  double radius_mm = 0;
};

/// The lobe F D V of isotropic GGX times n.l, in 1/sr, by the point of the ball that is nearest to the
/// mirrored view (Karis 2013, eq. 11, with the vector from the centre to that ray where the seed prints the
/// opposite), times (alpha / alpha')^2 (eq. 14) with alpha' of eq. 10: pi times this times the strength of
/// the light is the reading. For comparison: widened_alpha() is cheaper and nearer the truth. A light that
/// reaches the surface point or whose centre is at or below the horizon gives 0.
Rgb representative_point(const SphericalLight& light, Vec3 to_view, double alpha, const Rgb& f0);

}  // namespace weft::simulator
