// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"

namespace weft {

/// One LED close to the cloth, as an imperfect Lambertian point source (Queau et al., JMIV 2018, section 2):
/// at a point X it gives  Phi_c * g_c * max(0, -l . aim)^mu / d^2  with  d l = position - X.
struct NearLight {
  Vec3 position_mm;                            ///< rig frame
  Vec3 aim;                                    ///< unit, from the LED to the table
  double mu = 1;                               ///< lobe exponent: 0 isotropic, 1 Lambertian, above 1 narrower
  std::array<double, 3> flux_rgb = {1, 1, 1};  ///< Phi: reading * mm^2 / s at ISO 100, white balance included
  std::array<double, 6> log_gain_quadratic =
      {};  ///< 1, u, v, u^2, u v, v^2 with u, v in [-1, 1] over the frame
};

/// A smooth log gain over the frame, shared by all LEDs: uniform cubic tensor B-spline. Empty is no gain.
struct GainSpline {
  int columns = 0;                   ///< coefficients across the frame, at least 4
  int rows = 0;                      ///< coefficients down the frame, at least 4
  std::vector<double> coefficients;  ///< row by row

  bool empty() const { return coefficients.empty(); }
  /// Log gain at u, v in [-1, 1] over the frame (left to right, top to bottom).
  double at(double u, double v) const;
};

/// The lights of a rig. `leds[0]` is LED 1.
struct NearLights {
  std::vector<NearLight> leds;
  std::array<GainSpline, 3> log_gain_rgb;

  /// Log of g_c for a LED at u, v: the shared spline of channel c plus the LED's own quadratic.
  double log_gain(std::size_t led, int channel, double u, double v) const;
};

/// A light so far away that direction and irradiance are the same for every pixel.
struct DistantLight {
  Vec3 direction;                                    ///< unit, from the surface to the light
  std::array<double, 3> irradiance_rgb = {1, 1, 1};  ///< reading of a white surface that faces the light
};

struct DistantLights {
  std::vector<DistantLight> lights;
};

/// A patch of known reflectance that lies in the frame of every scan, as a white standard beside the cloth.
struct WhitePatch {
  std::vector<std::array<double, 2>> polygon_px = {};  ///< corners on the active area, at least three
  std::array<double, 3> reflectance_rgb = {1, 1, 1};
  double delta = 0;  ///< it reflects 1 - delta (1 - cosine) of Lambert's law
  std::optional<double> height_mm =
      {};  ///< where it lies, rig frame; where nobody said at the cloth's height
};

/// How far measured parameters may be off, as the fit that found them says. Those of lights are named
/// "led01.position_mm.x", ".y", ".z" (mm), "led01.aim.x" ... (the aim is normalised after it was changed),
/// "led01.mu", "led01.log_flux" (of all channels alike) and "led01.log_gain_quadratic.0" to ".5"; those of a
/// camera as CameraModel names them.
struct ParameterCovariance {
  std::vector<std::string> parameters;
  std::vector<double> matrix;  ///< row by row, symmetric, in the units of the parameters
};

/// Either kind; a distant light is never a near one that is far away.
using Lights = std::variant<NearLights, DistantLights>;

std::size_t light_count(const Lights& lights);

/// By channel, what makes white paper grey under all of them together, green being 1. None where a channel
/// has no light.
std::optional<std::array<double, 3>> white_gains(const Lights& lights);

/// The same lights, light k (from 0) `factors[k]` times as bright.
Lights brightened(Lights lights, const std::vector<double>& factors);

/// Only the lights with the given numbers (from 1), in that order. kUsage if one is not there or twice there.
Result<Lights> select_lights(const Lights& lights, const std::vector<int>& numbers);

}  // namespace weft
