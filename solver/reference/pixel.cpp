// SPDX-License-Identifier: Apache-2.0
#include "solver/reference/pixel.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "solver/method.h"

namespace weft::solver {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// One equilibrated row: x = r / e by plane, and `light` = sum of plane weights times x, which the normal is
// solved from.
struct Row {
  Vector3d l;
  std::array<double, 3> x = {};
  double light = 0;
  double inverse_strength = 0;  // of plane 0
};

// What is left of the rows that can be used at all; says in `status` why others cannot.
std::vector<Row> valid_rows(std::span<const PixelRow> rows, int planes, std::uint16_t& status) {
  std::vector<Row> valid;
  for (const PixelRow& row : rows) {
    bool missing = false, saturated = false, unlit = false;
    Row r = {Vector3d(row.direction.x, row.direction.y, row.direction.z), {}, 0, 1 / row.strength[0]};
    for (std::size_t p = 0; p < static_cast<std::size_t>(planes); ++p) {
      saturated |= row.reading[p] == std::numeric_limits<double>::infinity();
      missing |= !std::isfinite(row.reading[p]) && row.reading[p] != std::numeric_limits<double>::infinity();
      unlit |= !(row.strength[p] > 0);
      r.x[p] = row.reading[p] / row.strength[p];
      r.light += (planes == 1 ? 1.0 : kLuminance[p]) * r.x[p];
    }
    if (missing) {
      status |= kInvalidReading;
    } else if (saturated) {
      status |= kSaturated;
    } else if (unlit) {
      status |= kShadowed;
    } else {
      valid.push_back(r);
    }
  }
  return valid;
}

Matrix3d normal_matrix(const std::vector<Row>& rows) {
  Matrix3d g = Matrix3d::Zero();
  for (const Row& row : rows) g += row.l * row.l.transpose();
  return g;
}

// Leaves out what attached shadow darkened, unless too little would be left to solve with.
std::vector<Row> without_shadow(std::vector<Row> rows, std::size_t lights, std::uint16_t& status) {
  std::vector<double> sorted;
  for (const Row& row : rows) sorted.push_back(row.light);
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  const auto ranked = [&](int rank) {
    const auto i = static_cast<std::size_t>(rank) - 1;
    return i < sorted.size() ? sorted[i] : -std::numeric_limits<double>::infinity();
  };
  const double threshold = std::min(kShadowShare * ranked(bright_rank(lights)), ranked(kLeastKept));
  std::vector<Row> lit;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(lit),
               [&](const Row& row) { return row.light >= threshold; });
  if (lit.size() == rows.size() || normal_matrix(lit).determinant() <= kLeastMaskedDeterminant) return rows;
  status |= kShadowed;
  return lit;
}

PixelSolution unsolved(const std::vector<Row>& rows, const PixelOptions& options, std::uint16_t status) {
  PixelSolution s;
  s.status = status | kNoSolution;
  const auto planes = static_cast<std::size_t>(options.planes);
  double weight = 0;
  for (const Row& row : rows) weight += row.l.z() * row.l.z();
  if (!(weight > 0)) return s;
  for (std::size_t p = 0; p < planes; ++p) {
    double sum = 0, variance = 0;
    for (const Row& row : rows) {
      sum += row.l.z() * row.x[p];
      if (options.noise) {
        variance += std::pow(row.l.z() * row.inverse_strength, 2) *
                    options.noise->variance(row.x[p] / row.inverse_strength);
      }
    }
    s.albedo[p] = std::max(0.0, sum / weight);
    s.sigma_albedo[p] = options.noise ? std::sqrt(variance) / weight : s.albedo[p];
  }
  return s;
}

}  // namespace

PixelSolution solve_pixel(std::span<const PixelRow> rows, const PixelOptions& options) {
  const auto planes = static_cast<std::size_t>(options.planes);
  std::uint16_t status = 0;
  const std::vector<Row> valid = valid_rows(rows, options.planes, status);
  const std::vector<Row> used = options.shadow_mask ? without_shadow(valid, rows.size(), status) : valid;

  const double floor_sigma =
      options.noise && planes == 1 ? std::sqrt(options.noise->floor + options.noise->shared) : 0.0;
  const bool dark = !valid.empty() && std::none_of(valid.begin(), valid.end(), [&](const Row& r) {
    return r.light > 3 * floor_sigma * r.inverse_strength;
  });
  if (dark) status |= kDark;

  const Matrix3d g = normal_matrix(used);
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(g);
  const Vector3d& lambda = eigen.eigenvalues();
  if (used.size() < 3 || !(lambda[0] > 1e-15 * lambda[2])) return unsolved(valid, options, status);
  const Matrix3d inverse =
      eigen.eigenvectors() * lambda.cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose();
  if (std::sqrt(lambda[2] / lambda[0]) >= kIllConditionedFrom) status |= kIllConditioned;
  if (used.size() == 3) status |= kZeroDof;

  Vector3d b = Vector3d::Zero();
  std::array<Vector3d, 3> b_of_plane = {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  for (const Row& row : used) {
    b += inverse * row.l * row.light;
    for (std::size_t p = 0; p < planes; ++p) b_of_plane[p] += inverse * row.l * row.x[p];
  }
  const double rho = b.stableNorm();
  if (!(rho > 0) || !std::isfinite(rho)) return unsolved(valid, options, status);
  const Vector3d n = b / rho;

  // Residuals, and from the noise model or their scatter the covariance C = G^-1 M G^-1 of b.
  double residual2 = 0;
  std::array<double, 3> plane_residual2 = {};
  Matrix3d m = Matrix3d::Zero();
  Vector3d shared = Vector3d::Zero();
  for (const Row& row : used) {
    residual2 += std::pow(row.light - row.l.dot(b), 2);
    for (std::size_t p = 0; p < planes; ++p) {
      plane_residual2[p] += std::pow(row.x[p] - row.l.dot(b_of_plane[p]), 2);
    }
    if (options.noise) {
      const double predicted = std::max(0.0, row.l.dot(b)) / row.inverse_strength;
      m += options.noise->variance(predicted) * std::pow(row.inverse_strength, 2) * row.l * row.l.transpose();
      shared += row.inverse_strength * row.l;
    }
  }
  const auto count = static_cast<double>(used.size());
  const double freedom = count - 3;
  PixelSolution s;
  s.normal = {n.x(), n.y(), n.z()};
  s.residual = std::sqrt(residual2 / count) / rho;
  double noise_level2 = freedom > 0 ? residual2 / freedom : 0;
  const bool modelled = planes == 1 && options.noise;
  if (modelled) {
    m += options.noise->shared * shared * shared.transpose();
    const Matrix3d c = inverse * m * inverse;
    s.sigma_normal_deg = degrees(std::sqrt(std::max(0.0, c.trace() - n.dot(c * n))) / rho);
    s.sigma_albedo[0] = std::sqrt(std::max(0.0, n.dot(c * n)));
    s.albedo[0] = rho;
  } else {
    s.sigma_normal_deg =
        freedom > 0
            ? degrees(std::sqrt(noise_level2 * std::max(0.0, inverse.trace() - n.dot(inverse * n))) / rho)
            : kUnknownAngleDeg;
    for (std::size_t p = 0; p < planes; ++p) {
      s.albedo[p] = planes == 1 ? rho : std::max(0.0, n.dot(b_of_plane[p]));
      s.sigma_albedo[p] =
          freedom > 0 ? std::sqrt(plane_residual2[p] / freedom * n.dot(inverse * n)) : s.albedo[p];
    }
  }
  s.sigma_normal_deg = std::min(s.sigma_normal_deg, double{kUnknownAngleDeg});

  for (const Row& row : used) {
    const double predicted = std::max(0.0, row.l.dot(b));
    const double sigma =
        modelled ? std::sqrt(options.noise->variance(predicted / row.inverse_strength)) * row.inverse_strength
                 : 0.0;
    if (row.light > kSpecularTimes * predicted + 3 * sigma + kSpecularMargin * rho) status |= kSpecular;
  }
  s.status = status;
  return s;
}

}  // namespace weft::solver
