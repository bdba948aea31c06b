// SPDX-License-Identifier: Apache-2.0
#include "bench/base/bound.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace weft::bench {

double TangentCovariance::rms_deg() const {
  return degrees(std::sqrt(c11 + c22));
}

double TangentCovariance::chi_square(Vec3 estimate, double claimed_rms_deg) const {
  const double e1 = dot(estimate, first), e2 = dot(estimate, second);
  const double square = (c22 * e1 * e1 - 2 * c12 * e1 * e2 + c11 * e2 * e2) / (c11 * c22 - c12 * c12);
  const double claimed = radians(claimed_rms_deg);
  return square * (c11 + c22) / (claimed * claimed);
}

TangentCovariance cramer_rao(std::span<const LightField::Light> lights, Vec3 normal, double albedo,
                             const NoiseModel& noise) {
  constexpr double kSingular = 1e-12;  // of the product of the diagonal
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d with_shared = Eigen::Vector3d::Zero();
  double weight = 0;
  for (const LightField::Light& light : lights) {
    const double mean = albedo * light.strength * dot(normal, light.direction);
    const double w = 1 / noise.variance(mean);
    const Eigen::Vector3d a =
        light.strength * Eigen::Vector3d(light.direction.x, light.direction.y, light.direction.z);
    information += w * a * a.transpose();
    with_shared += w * a;
    weight += w;
  }
  // (diag(v) + s 1 1^T)^-1 by Sherman and Morrison.
  information -= noise.shared / (1 + noise.shared * weight) * with_shared * with_shared.transpose();

  TangentCovariance tangent;
  tangent.first = normalized(std::abs(normal.x) < 0.5 ? cross(normal, {1, 0, 0}) : cross(normal, {0, 1, 0}));
  tangent.second = cross(normal, tangent.first);
  if (!(information.determinant() > kSingular * information.diagonal().prod())) {
    tangent.c11 = tangent.c22 = std::numeric_limits<double>::infinity();
    return tangent;
  }
  const Eigen::Matrix3d c = information.inverse() / (albedo * albedo);
  const Eigen::Vector3d t1(tangent.first.x, tangent.first.y, tangent.first.z);
  const Eigen::Vector3d t2(tangent.second.x, tangent.second.y, tangent.second.z);
  tangent.c11 = t1.dot(c * t1);
  tangent.c12 = t1.dot(c * t2);
  tangent.c22 = t2.dot(c * t2);
  return tangent;
}

}  // namespace weft::bench
