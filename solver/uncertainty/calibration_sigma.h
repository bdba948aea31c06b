// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/rig/light_field.h"
#include "core/rig/lights.h"
#include "core/rig/radiometry.h"

namespace weft::solver {

/// What errors of the lights make of one pixel's solution: the same error in every scan, that no further
/// photograph averages away.
struct CalibrationSigma {
  double normal_deg = 0;       ///< sqrt(tr(P C P)) / rho in degrees: rms angle, as the noise's own
  double relative_albedo = 0;  ///< standard deviation over the albedo, alike in all channels
};

/// First-order propagation of the covariance of the lights to b = rho n. With readings r = A b, whose row k
/// is e_k l_k, a change d theta of the lights makes the model wrong by (dA/dtheta b) d theta, and the
/// weighted fit answers with
///   d b = -(A^T W A)^-1 A^T W (dA/dtheta b) d theta = K d theta,   C = K Sigma K^T.
/// Each light is a point with position s, aim a (normalised), lobe mu and flux Phi; with v = s - X the
/// logarithm of its reading changes by
///   d/ds = mu a / (v.a) + n / (v.n) - (mu + 3) v / |v|^2,   d/da = mu (v / (v.a) - a),
///   d/dmu = ln(-v.a / |v|),   d/dln Phi = 1,   d/dq_i = {1, u, v, u^2, u v, v^2}_i.
/// The fit is taken to use every LED that the normal faces, which a solve that leaves out shadows and
/// highlights does not; W is 1 / variance by `noise`, or without one that of readings over their strength.
class CalibrationSigmas {
 public:
  /// `leds[k]` is the number in the rig (from 1) of light k of `field`, which lies on a frame of `size` and
  /// must outlive this object. Parameters of other LEDs are not used. kBadData where the lights are distant
  /// or a parameter's name is unknown.
  static Result<CalibrationSigmas> make(const LightField& field, Size size, std::span<const int> leds,
                                        const ParameterCovariance& covariance,
                                        const std::optional<NoiseModel>& noise);

  /// At pixel (x, y) with a unit normal and an albedo of channel c; 180 degrees and 1 where fewer than three
  /// LEDs face it.
  CalibrationSigma at(int x, int y, int c, Vec3 normal, double albedo) const;

  /// Covariance of what is wrong with each light as pixel (x, y) sees it: four a light, row by row, of the
  /// logarithm of its strength and of x, y and z of its unit direction in the rig frame.
  std::vector<double> light_errors_at(int x, int y) const;

 private:
  enum class Kind { kPosition, kAim, kMu, kLogFlux, kLogGain };
  struct Parameter {
    std::size_t light = 0;
    Kind kind = Kind::kPosition;
    int axis = 0;
  };
  static std::optional<Parameter> parameter_named(const std::string& name, std::span<const int> leds,
                                                  bool& is_known);
  double log_derivative(const Parameter& parameter, Vec3 v, Vec3 normal, int x, int y) const;

  const LightField* field_ = nullptr;
  Size size_;
  std::vector<Parameter> parameters_;
  std::vector<double> sigma_;  ///< covariance of `parameters_`, row by row
  std::optional<NoiseModel> noise_;
};

}  // namespace weft::solver
