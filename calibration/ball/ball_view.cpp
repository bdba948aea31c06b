// SPDX-License-Identifier: Apache-2.0
#include "calibration/ball/ball_view.h"

#include <Eigen/Dense>
#include <cmath>

namespace weft::calibration {

BallView::BallView(const Outline& outline, Size picture, double focal_px)
    : circle_(outline.circle), picture_(picture), focal_px_(focal_px) {
  if (!(focal_px > 0)) return;
  // Rays u that touch the ball have u . m = 1 for m = axis / cos(half angle): linear in m.
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  const auto add = [&](double x, double y) {
    const Vec3 u = ray(x, y);
    const Eigen::Vector3d v(u.x, u.y, u.z);
    a += v * v.transpose();
    b += v;
  };
  for (const auto& [x, y] : outline.edge) add(x, y);
  if (outline.edge.size() < 12) {
    for (int i = 0; i < 64; ++i)
      add(circle_.x + circle_.radius * std::cos(2 * kPi * i / 64),
          circle_.y + circle_.radius * std::sin(2 * kPi * i / 64));
  }
  const Eigen::Vector3d m = a.ldlt().solve(b);
  const double size = m.norm();
  axis_ = {m[0] / size, m[1] / size, m[2] / size};
  sine_ = std::sqrt(std::max(0.0, 1 - 1 / (size * size)));
}

Vec3 BallView::ray(double x, double y) const {
  return normalized({x - (picture_.width - 1) / 2.0, (picture_.height - 1) / 2.0 - y, -focal_px_});
}

std::optional<BallPoint> BallView::at(double x, double y) const {
  if (!(focal_px_ > 0)) {
    const double nx = (x - circle_.x) / circle_.radius, ny = (circle_.y - y) / circle_.radius;
    const double zz = 1 - nx * nx - ny * ny;
    if (zz <= 0) return std::nullopt;
    return BallPoint{{nx, ny, std::sqrt(zz)}, {0, 0, 1}};
  }
  const Vec3 u = ray(x, y);
  const double along = dot(u, axis_), inside = along * along - 1 + sine_ * sine_;
  if (inside <= 0) return std::nullopt;
  const double distance = along - std::sqrt(inside);  // in distances of the centre
  return BallPoint{(1 / sine_) * (distance * u - axis_), -1 * u};
}

Vec3 BallView::centre_mm(double radius_mm) const {
  if (focal_px_ > 0) return (radius_mm / sine_) * axis_;
  const double mm = radius_mm / circle_.radius;
  return {mm * (circle_.x - (picture_.width - 1) / 2.0), mm * ((picture_.height - 1) / 2.0 - circle_.y), 0};
}

}  // namespace weft::calibration
