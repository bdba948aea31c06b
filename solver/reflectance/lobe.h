// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/base/vec.h"

// How a cloth reflects a small light, as photographs show it. The simulator has models of its own
// (simulator/reflectance), so that neither is tested against itself.

namespace weft::solver {

enum class LobeFamily {
  kLambert,         ///< no lobe
  kGgx,             ///< Walter et al. 2007
  kAnisotropicGgx,  ///< Heitz 2014: `alpha` across the yarn, `along` times as much along it
  kBeckmann,        ///< Walter et al. 2007, eq. 25
  kCloth,           ///< Ashikhmin and Premoze 2007, normed as seed 000 eq. 22 and 23
  kTwoGgx,          ///< GGX twice in every point, sharp and broad: a finish on rough fibres
};
const char* name_of(LobeFamily family);

/// What the pixels of one material share. A reading over its strength is
///
///   x = (n . l) (rho (1 - F) (1 - bend (1 - n . l)) + s pi F D V),  F = f0 + (1 - f0) (1 - l . h)^5
///
/// with the half-vector h and the share s of the lobe that reaches the reading, and 0 where the light is
/// below the surface. rho and n are each pixel's own.
struct Lobe {
  LobeFamily family = LobeFamily::kLambert;
  double alpha = 1;  ///< roughness, 0.02 to 1; of a pixel: what lies below it is in it
  double f0 = 0;     ///< 0 to 0.6; of readings of one colour times `tint`
  double along = 1;  ///< alpha along the yarn over that across it, 0.05 to 20
  double axis = 0;   ///< azimuth of the warp, radians from the x axis of the rig; weft lies across it
  double bend = 0;   ///< how much the diffuse part falls short of Lambert's law at grazing light
  double broad = 1;  ///< of two lobes alpha of the broad one, `alpha` is that of the sharp one; 0.02 to 1
  double broad_share = 0;  ///< of the facets, which are of the broad one; 0 to 1
  /// f0 of red, green and blue over `f0`, 0 or more; all 1: a highlight has the colour of the light.
  std::array<double, 3> tint = {1, 1, 1};

  bool shines() const { return family != LobeFamily::kLambert; }
  bool is_tinted() const { return tint != std::array<double, 3>{1, 1, 1}; }
  /// One of two lobes by itself, as if all facets were its own.
  Lobe sharp_part() const {
    return {.family = LobeFamily::kGgx, .alpha = alpha, .f0 = f0, .bend = bend, .tint = tint};
  }
  Lobe broad_part() const {
    return {.family = LobeFamily::kGgx, .alpha = broad, .f0 = f0, .bend = bend, .tint = tint};
  }
  friend bool operator==(const Lobe&, const Lobe&) = default;
};

/// One light over one pixel, with what no normal changes.
struct LitFrom {
  Vec3 light, view;
  Vec3 half;
  double light_half = 0;  ///< l . h
  double lobe_share = 1;  ///< s above, over the share of the diffuse part: 2 through parallel films
  int channel = kMixed;   ///< of the reading: 0 red to 2 blue
  /// A weighted sum of the channels: f0 is that of the lobe.
  static constexpr int kMixed = -1;

  LitFrom() = default;
  LitFrom(Vec3 to_light, Vec3 to_camera, double share_of_lobe = 1);
};

/// F at normal incidence for readings of a channel or of LitFrom::kMixed, 1 at most.
double f0_of(const Lobe& lobe, int channel);

/// s pi F D V of a normal. `yarn`: azimuth of the pixel's yarn from `axis`, radians.
double specular(const Lobe& lobe, Vec3 normal, const LitFrom& from, double yarn);

/// The angle of normal and half-vector at which a lobe as rough along the yarn as across it would be as
/// dense, radians: what draws lobes of two roughnesses as one curve. `yarn` as above.
double equal_angle(const Lobe& lobe, Vec3 normal, Vec3 half, double yarn);
/// The density of facets at such an angle over that at 0, where the lobe has its peak.
double relative_facets(const Lobe& lobe, double equal_angle);

/// The alpha that one lobe of GGX needs to look like this one, across the yarn where there is one: of two
/// lobes the harmonic mean, each with its share. f0 stays.
double alpha_of_one(const Lobe& lobe);

/// x and its derivative by b = rho n.
struct ModelledReading {
  double x = 0;
  Vec3 by_b;
};
double modelled(const Lobe& lobe, Vec3 b, const LitFrom& from, double yarn);
ModelledReading modelled_with_derivative(const Lobe& lobe, Vec3 b, const LitFrom& from, double yarn);

}  // namespace weft::solver
