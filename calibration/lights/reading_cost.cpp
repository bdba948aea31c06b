// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/reading_cost.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace weft::calibration {
namespace {

// Derivative by the rotation vector `at` itself of what changes by `g` with a small turn after it: the left
// Jacobian of SO(3), to third order in an angle of a degree or two.
Vec3 by_rotation_vector(const double* at, Vec3 g) {
  const Vec3 w = vec_of(at);
  return g - 0.5 * cross(w, g) + (1.0 / 6) * cross(w, cross(w, g));
}

// Value of each coefficient's basis function at a place of the frame.
std::vector<double> basis_at(const LightFitOptions& o, double u, double v) {
  GainSpline spline = {o.spline_columns, o.spline_rows, {}};
  spline.coefficients.resize(static_cast<std::size_t>(o.spline_columns) *
                             static_cast<std::size_t>(o.spline_rows));
  std::vector<double> basis;
  for (double& coefficient : spline.coefficients) {
    coefficient = 1;
    basis.push_back(spline.at(u, v));
    coefficient = 0;
  }
  return basis;
}

}  // namespace

Pose pose_of(const Pose& start, const double* turn_and_shift) {
  return moved(start, vec_of(turn_and_shift), vec_of(turn_and_shift + 3));
}

std::optional<std::array<double, 3>> sigma_of(const PaperScene& scene, const PaperReading& reading,
                                              const LightFitOptions& options) {
  const Pose& pose = scene.sheets[reading.sheet].rig_from_sheet;
  const auto point = point_on_sheet(sight_of(scene.camera, reading.x_px, reading.y_px), pose);
  if (!point) return {};
  const Vec3 to_led = scene.lights.leds[reading.led].position_mm - *point;
  const double along = dot(normal_of(pose), to_led);
  if (!(along > 0)) return {};
  const double tangent = length(cross(normal_of(pose), to_led)) / along;
  const double paper = std::hypot(options.unevenness, radians(options.flatness_deg) * tangent);
  std::array<double, 3> sigma = {};
  for (std::size_t c = 0; c < 3; ++c) sigma[c] = std::hypot(reading.relative_sigma[c], paper);
  return sigma;
}

// The integral of a cubic B-spline over the intervals in the frame.
std::vector<double> mean_basis(const LightFitOptions& o) {
  const auto means = [](int count) {
    constexpr std::array<double, 4> kPiece = {1.0 / 24, 11.0 / 24, 11.0 / 24, 1.0 / 24};
    std::vector<double> mean(static_cast<std::size_t>(count));
    for (int interval = 0; interval < count - 3; ++interval) {
      for (std::size_t i = 0; i < 4; ++i)
        mean[static_cast<std::size_t>(interval) + i] += kPiece[i] / (count - 3);
    }
    return mean;
  };
  std::vector<double> basis;
  for (const double row : means(o.spline_rows)) {
    for (const double column : means(o.spline_columns)) basis.push_back(row * column);
  }
  return basis;
}

RowMatrix third_differences(const LightFitOptions& o) {
  std::vector<std::array<int, 4>> runs;
  for (int y = 0; y < o.spline_rows; ++y) {
    for (int x = 0; x < o.spline_columns; ++x) {
      const int at = y * o.spline_columns + x, down = o.spline_columns;
      if (x + 3 < o.spline_columns) runs.push_back({at, at + 1, at + 2, at + 3});
      if (y + 3 < o.spline_rows) runs.push_back({at, at + down, at + 2 * down, at + 3 * down});
    }
  }
  RowMatrix rows = RowMatrix::Zero(static_cast<Eigen::Index>(runs.size()), o.spline_columns * o.spline_rows);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    constexpr std::array<double, 4> kThird = {-1, 3, -3, 1};
    for (std::size_t j = 0; j < 4; ++j) rows(static_cast<Eigen::Index>(i), runs[i][j]) = kThird[j];
  }
  return rows;
}

ReadingCost::ReadingCost(const PaperScene& start, const PaperReading& reading,
                         const std::array<double, 3>& sigma, const LightFitOptions& options)
    : sight_(sight_of(start.camera, reading.x_px, reading.y_px)),
      paper_(start.paper),
      pose_(start.sheets[reading.sheet].rig_from_sheet) {
  const auto [u, v] = frame_place(start.camera.size, reading.x_px, reading.y_px);
  quadratic_ = {u, v, u * u, u * v, v * v};
  basis_ = basis_at(options, u, v);
  for (std::size_t c = 0; c < 3; ++c) {
    target_[c] = std::log(reading.reading_rgb[c] / start.paper.reflectance_rgb[c]);
    weight_[c] = 1 / sigma[c];
  }
  const auto n = static_cast<int>(basis_.size());
  *mutable_parameter_block_sizes() = {3, 3, 1, 3, static_cast<int>(kOwnGains), n, n, n, 6, 6, 1};
  set_num_residuals(3);
}

bool ReadingCost::Evaluate(double const* const* p, double* residuals, double** jacobians) const {
  NearLight led;
  led.position_mm = vec_of(p[0]);
  led.aim = vec_of(p[1]);
  led.mu = p[2][0];
  Paper paper = paper_;
  std::copy_n(p[8], 5, paper.log_albedo.begin());
  paper.delta = p[8][5];
  const std::optional<PaperTerm> term = paper_term(sight_, led, paper, pose_of(pose_, p[9]));
  if (!term) return false;
  const double own = std::inner_product(quadratic_.begin(), quadratic_.end(), p[4], 0.0);
  for (std::size_t c = 0; c < 3; ++c) {
    const double gain = std::inner_product(basis_.begin(), basis_.end(), p[5 + c], own);
    residuals[c] = weight_[c] * (term->log_value + p[3][c] + gain + p[10][0] - target_[c]);
  }
  if (jacobians != nullptr) differentiate(*term, p[9], jacobians);
  return true;
}

void ReadingCost::differentiate(const PaperTerm& term, const double* sheet, double** jacobians) const {
  const Vec3 by_turn = by_rotation_vector(sheet, term.by_turn);
  const auto fill = [&](std::size_t block, std::span<const double> row) {
    if (jacobians[block] == nullptr) return;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < row.size(); ++i) jacobians[block][c * row.size() + i] = weight_[c] * row[i];
    }
  };
  fill(0, array_of(term.by_position));
  fill(1, array_of(term.by_aim));
  fill(2, std::array{term.by_mu});
  fill(4, quadratic_);
  const auto& q = term.by_log_albedo;
  fill(8, std::array{q[0], q[1], q[2], q[3], q[4], term.by_delta});
  const Vec3 m = term.by_centre;
  fill(9, std::array{by_turn.x, by_turn.y, by_turn.z, m.x, m.y, m.z});
  fill(10, std::array{1.0});
  if (jacobians[3] != nullptr) {
    std::fill_n(jacobians[3], 9, 0.0);
    for (std::size_t c = 0; c < 3; ++c) jacobians[3][4 * c] = weight_[c];
  }
  for (std::size_t c = 0; c < 3; ++c) {
    if (jacobians[5 + c] == nullptr) continue;
    std::fill_n(jacobians[5 + c], 3 * basis_.size(), 0.0);
    for (std::size_t i = 0; i < basis_.size(); ++i)
      jacobians[5 + c][c * basis_.size() + i] = weight_[c] * basis_[i];
  }
}

LinearPrior::LinearPrior(RowMatrix weights, Eigen::VectorXd expected, std::vector<int> blocks)
    : weights_(std::move(weights)), expected_(std::move(expected)) {
  *mutable_parameter_block_sizes() = std::move(blocks);
  set_num_residuals(static_cast<int>(weights_.rows()));
}

bool LinearPrior::Evaluate(double const* const* p, double* residuals, double** jacobians) const {
  Eigen::VectorXd off = -expected_;
  Eigen::Index at = 0;
  for (std::size_t b = 0; b < parameter_block_sizes().size(); ++b) {
    const Eigen::Index size = parameter_block_sizes()[b];
    off.segment(at, size) += Eigen::Map<const Eigen::VectorXd>(p[b], size);
    if (jacobians != nullptr && jacobians[b] != nullptr)
      Eigen::Map<RowMatrix>(jacobians[b], weights_.rows(), size) = weights_.middleCols(at, size);
    at += size;
  }
  Eigen::Map<Eigen::VectorXd>(residuals, weights_.rows()) = weights_ * off;
  return true;
}

LinearPrior* prior(std::span<const double> expected, double sigma) {
  const auto n = static_cast<Eigen::Index>(expected.size());
  return new LinearPrior(RowMatrix::Identity(n, n) / sigma,
                         Eigen::Map<const Eigen::VectorXd>(expected.data(), n), {static_cast<int>(n)});
}

}  // namespace weft::calibration
