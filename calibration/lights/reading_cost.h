// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "calibration/lights/paper_model.h"
#include "calibration/lights/physical.h"

// Residuals of the fit of physical.h, as Ceres wants them.

namespace weft::calibration {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Terms of a LED's own log gain that are fitted: the constant one is its flux.
inline constexpr std::size_t kOwnGains = 5;

/// Vectors as Ceres holds them.
inline Vec3 vec_of(const double* p) {
  return {p[0], p[1], p[2]};
}
inline std::array<double, 3> array_of(Vec3 v) {
  return {v.x, v.y, v.z};
}

/// Where a sheet lies after a turn and a shift, six numbers.
Pose pose_of(const Pose& start, const double* turn_and_shift);

/// How well a reading is known, relative: its own error, the unevenness of paper, and what its waves do under
/// light that grazes it. Nothing where the LED does not light the sheet.
std::optional<std::array<double, 3>> sigma_of(const PaperScene& scene, const PaperReading& reading,
                                              const LightFitOptions& options);

/// Mean over the frame of each basis function of the shared log gain.
std::vector<double> mean_basis(const LightFitOptions& options);
/// Third differences of neighbouring coefficients, along rows and columns: where no paper was seen a gain
/// goes on as a parabola, as vignettes do.
RowMatrix third_differences(const LightFitOptions& options);

/// Residuals of the three channels of one reading. Blocks: position, aim, mu, log flux, own gains, the
/// splines of R, G and B, paper (log albedo and delta), sheet (pose_of()), log gain of the shot.
class ReadingCost : public ceres::CostFunction {
 public:
  ReadingCost(const PaperScene& start, const PaperReading& reading, const std::array<double, 3>& sigma,
              const LightFitOptions& options);
  bool Evaluate(double const* const* p, double* residuals, double** jacobians) const override;

 private:
  void differentiate(const PaperTerm& term, const double* sheet, double** jacobians) const;

  LineOfSight sight_;
  Paper paper_;
  Pose pose_;
  std::array<double, kOwnGains> quadratic_;
  std::vector<double> basis_;
  std::array<double, 3> target_, weight_;
};

/// weights * (parameters - expected): rows of `weights` are residuals. Parameters may lie in several blocks.
class LinearPrior : public ceres::CostFunction {
 public:
  LinearPrior(RowMatrix weights, Eigen::VectorXd expected, std::vector<int> blocks);
  bool Evaluate(double const* const* p, double* residuals, double** jacobians) const override;

 private:
  RowMatrix weights_;
  Eigen::VectorXd expected_;
};

/// Independent priors of one width on a block.
LinearPrior* prior(std::span<const double> expected, double sigma);

}  // namespace weft::calibration
