// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/base/vec.h"
#include "core/rig/light_field.h"
#include "core/rig/radiometry.h"

// What noise does not say of a solved normal's error: light from the cloth itself, which fits Lambert's law
// and shows in no residual, and what does not fit it, such as highlights and cast shadows.

namespace weft::solver {

/// The mean square residual over the albedo squared that noise alone leaves at a photosite. With N lights of
/// strength e_k that give a Lambertian point the readings r_k it is
///   (N - 3) / N * mean over k of variance(r_k) / (e_k rho)^2,
/// which is linear in the normal, as r_k is.
struct ResidualNoise {
  std::array<float, 3> photons = {};  ///< of which it is (photons . n + floor / albedo) / albedo
  float floor = 0;
};

/// That of channel c around pixel (x, y).
ResidualNoise residual_noise(const LightField& field, const NoiseModel& noise, int x, int y, int c);

/// Degrees of rms angle for each unit of residual over the albedo, if misfits were independent: the root of
/// N / (N - 3) tr(P G^-1 P), with G the sum of l l^T over the N lights and P across an upright normal. Lights
/// beyond kIndependentLights stand so near to others that what does not fit is the same: they make nothing
/// surer. 0 with fewer than four lights, which fit anything.
inline constexpr double kIndependentLights = 12;
double degrees_a_residual(const LightField& field, int x, int y);

/// How the normals were solved.
struct ModelTraits {
  bool bounces_are_out = false;  ///< light from the cloth was taken out of the readings
  bool is_half = false;          ///< at half the size, and without a shadow mask
  double sigma_slope = 0;        ///< all slopes may be off by this share of themselves
  bool is_fast = false;          ///< without regard to shadows
  double lobe_share = 0;         ///< of the frame's blocks, solved with a lobe
  double lobe_misfit = 1;  ///< chi-square that the best lobe leaves of its readings; 1 where none was sought
  double unpredicted = 1;  ///< error of left-out light over that of noise; 1 where that is not known
  double turned_deg = 1;   ///< median of the jackknife's sigma of normals; 1 where it is not known
};

/// Square of the angle, in radians, that lies between the normal of a preview's pixel and those of the four
/// photosites it stands for, as far as a row or a column shows it: by the length of the step to the pixel's
/// normal from the one before, and from it to the one after. A step counts as positive where normals part, as
/// over a yarn, and as negative where they meet, as between two.
float within_pixel2(float step_before, float step_after);

/// Mean over rms of an angle whose two components scatter alike, as those of sigma do: sqrt(pi) / 2.
inline constexpr double kMeanOfRms = 0.886226925452758;

}  // namespace weft::solver
