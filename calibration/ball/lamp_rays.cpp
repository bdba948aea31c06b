// SPDX-License-Identifier: Apache-2.0
#include "calibration/ball/lamp_rays.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace weft::calibration {

std::optional<LampPlace> meeting_of(std::span<const LampRay> rays) {
  if (rays.size() < 2) return std::nullopt;
  const auto vector = [](Vec3 v) { return Eigen::Vector3d(v.x, v.y, v.z); };
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Matrix3d a;
  for (int i = 0; i < 4; ++i) {
    a.setZero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (const LampRay& ray : rays) {
      const Eigen::Vector3d d = vector(ray.direction), o = vector(ray.origin_mm);
      const double away = i == 0 ? 1 : std::max((place - o).norm(), 1.0);
      const double sigma = away * radians(std::max(ray.sigma_deg, 1e-3));
      const Eigen::Matrix3d across = (Eigen::Matrix3d::Identity() - d * d.transpose()) / (sigma * sigma);
      a += across;
      b += across * o;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(a);
    if (!(axes.eigenvalues()[0] > 1e-9 * axes.eigenvalues()[2])) return std::nullopt;
    place = a.ldlt().solve(b);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(a);
  const double sigma = 1 / std::sqrt(axes.eigenvalues()[0]);
  for (const LampRay& ray : rays) {
    const Eigen::Vector3d away = place - vector(ray.origin_mm);
    if (!(away.dot(vector(ray.direction)) > 2 * sigma)) return std::nullopt;
  }
  return LampPlace{{place[0], place[1], place[2]}, sigma};
}

}  // namespace weft::calibration
