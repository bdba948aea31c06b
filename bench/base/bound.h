// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/base/vec.h"
#include "core/rig/light_field.h"
#include "core/rig/radiometry.h"

namespace weft::bench {

/// Covariance of a normal about the true one, in the tangent plane there: rad^2, along two unit vectors.
struct TangentCovariance {
  Vec3 first, second;
  double c11 = 0, c12 = 0, c22 = 0;

  /// sqrt of the trace: the rms angle.
  double rms_deg() const;
  /// e^T C^-1 e for the error e of an estimate, with C scaled to another rms angle: what a method says of the
  /// size of its errors is tested with the shape that they should have.
  double chi_square(Vec3 estimate, double claimed_rms_deg) const;
};

/// What no unbiased estimate from one photosite can beat (Rao 1945, Cramer 1946): b = rho n, readings
/// a_k . b with a = e l and covariance V = diag(v) + shared, Fisher information J = A^T V^-1 A, and of the
/// normal P J^-1 P / rho^2 with P = 1 - n n^T. What the variances themselves tell of b, one part in
/// thousands, is left out. `lights` are those that the point faces and sees; the rms angle is infinite where
/// they do not span three dimensions.
TangentCovariance cramer_rao(std::span<const LightField::Light> lights, Vec3 normal, double albedo,
                             const NoiseModel& noise);

}  // namespace weft::bench
