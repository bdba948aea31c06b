// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "calibration/lights/reading_cost.h"
#include "core/base/vec.h"
#include "core/rig/lights.h"

// What the fit of lights (physical.h) varies, in blocks as Ceres wants them.

namespace weft::calibration {

struct LedParameters {
  std::array<double, 3> position_mm, aim, log_flux;
  double mu = 1;
  std::array<double, kOwnGains> quadratic = {};
};
struct Parameters {
  std::vector<LedParameters> leds;
  std::array<std::vector<double>, 3> splines;
  std::array<double, 6> paper = {};           // log albedo, delta
  std::vector<std::array<double, 6>> sheets;  // turn and shift from the pose that the tags gave
  std::vector<double> shots;                  // log gain of each, sheet by sheet
};

/// A row of the parameters that the covariance names, from those of the fit.
struct Named {
  std::string name;
  Eigen::VectorXd row;
};

inline NearLight led_of(const LedParameters& p) {
  NearLight led;
  led.position_mm = vec_of(p.position_mm.data());
  led.aim = vec_of(p.aim.data());
  led.mu = p.mu;
  for (std::size_t c = 0; c < 3; ++c) led.flux_rgb[c] = std::exp(p.log_flux[c]);
  std::copy(p.quadratic.begin(), p.quadratic.end(), led.log_gain_quadratic.begin() + 1);
  return led;
}

/// A whitening matrix W with W^T W the inverse of the covariance of a pose; widths of nothing become tiny
/// ones. Empty where it has none.
inline RowMatrix whitening(const SheetPose& pose) {
  Eigen::Matrix<double, 6, 6> covariance;
  for (int i = 0; i < 36; ++i) covariance(i / 6, i % 6) = pose.covariance[static_cast<std::size_t>(i)];
  for (int i = 0; i < 6; ++i) covariance(i, i) += i < 3 ? 1e-12 : 1e-8;
  const Eigen::LLT<Eigen::Matrix<double, 6, 6>> factor(covariance);
  if (factor.info() != Eigen::Success) return {};
  return factor.matrixL().solve(Eigen::Matrix<double, 6, 6>::Identity());
}

}  // namespace weft::calibration
