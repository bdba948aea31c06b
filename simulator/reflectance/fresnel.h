// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/vec.h"
#include "core/image/color_spaces.h"

// What the surface of a fibre reflects, and what that leaves for the colour beneath.

namespace weft::simulator {

/// (1 - x)^5 for x from 0 to 1.
inline double fifth_power_of_rest(double x) {
  const double rest = 1 - x, square = rest * rest;
  return square * square * rest;
}

/// Fresnel's reflectance where l . h is `cosine`, from f0 at normal incidence (Schlick 1994; seed
/// 001 eq. 38).
inline double schlick(double f0, double cosine) {
  return f0 + (1 - f0) * fifth_power_of_rest(cosine);
}

/// What reaches and leaves the Lambertian part beneath the lobe.
enum class Beneath {
  /// Everything (seed 004, first equation): lobe and albedo add up, to more than 1 for a white cloth.
  kLambert,
  /// What the mirroring facets let in, 1 - F(l.h) (seed 000 eq. 15). The seed calls that not reciprocal; as
  /// printed it is, since l.h = v.h. What is not is 1 - F(n.l), of Shirley 1991.
  kBalanced,
  /// What a polished surface lets in and out (Shirley et al. 1997; seed 001 eq. 61-62, with 1 - (1 - n.l)^5
  /// where it prints 1 - (n.l)^5). Reciprocal; black where light or view graze.
  kCoupled,
};

/// The cosines that a lobe over a diffuse part depends on, from 0 to 1.
struct Cosines {
  double n_l = 0, n_v = 0, l_h = 0;
};

/// F(l.h) `lobe` + what scatters beneath: `lobe` is D V in 1/sr, without Fresnel.
Rgb lobe_over_diffuse(double lobe, const Rgb& f0, Beneath beneath, const Rgb& albedo, const Cosines& cosines);

}  // namespace weft::simulator
