// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "solver/reflectance/lobe_fit.h"

namespace weft::solver {

/// An error of a light is the same in all pixels, and no number of them averages it away. To first order it
/// moves the shared values of a lobe by K times the error, and their covariance is K Sigma K^T (Schmidt
/// 1966).
class LobeByLights {
 public:
  /// Errors of one light: of the logarithm of its strength, and of x, y and z of its direction in the rig
  /// frame.
  static constexpr std::size_t kErrors = 4;

  LobeByLights() = default;
  /// Changes of a lobe as it was fitted; from at most 1000 of its pixels.
  LobeByLights(const LobeSamples& samples, const LobeFit& fit, const LobeParameters& fitted);

  std::size_t errors() const { return change_.front().size(); }
  /// Change of a shared value by each error, four a light.
  std::span<const double> change_of(LobeParameter parameter) const {
    return change_[static_cast<std::size_t>(parameter)];
  }
  /// The covariance of the shared values, for one of all errors, row by row.
  LobeCovariance covariance_of(std::span<const double> errors) const;

 private:
  std::array<std::vector<double>, kLobeParameters> change_;
};

/// Slopes of one reading by the errors of its light, where the lobe makes `of_model` of it.
std::array<double, LobeByLights::kErrors> slopes_by_errors(const Lobe& lobe, const LobeReading& reading,
                                                           Vec3 b, double yarn, double of_model);

}  // namespace weft::solver
