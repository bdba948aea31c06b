// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/scene_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace weft::simulator {
namespace {

constexpr double kLeastStretch = 0.05;
constexpr double kLeastSine = 0.0175;  // of a degree
constexpr int kStepsToCorner = 512;
constexpr int kStepsAlongEdge = 64;
constexpr int kMostNewtonSteps = 100;
constexpr double kLastResidual = 1e-8;  // its square is what the next step leaves

Error refusal(std::string what, std::string why, std::string remedy) {
  return {ErrorKind::kBadData, std::move(what), "camera", std::move(why), std::move(remedy)};
}

Vec3 column(const Mat3& m, std::size_t i) {
  return {m[0][i], m[1][i], m[2][i]};
}

/// Turns z by `tilt` towards the azimuth, about a level axis (Rodrigues 1840).
Mat3 tilt_matrix(double tilt, double azimuth) {
  const double c = std::cos(azimuth), s = std::sin(azimuth);
  const double sine = std::sin(tilt), rise = 1 - std::cos(tilt);
  return {{{1 - rise * c * c, -rise * c * s, sine * c},
           {-rise * c * s, 1 - rise * s * s, sine * s},
           {-sine * c, -sine * s, 1 - rise}}};
}

}  // namespace

Result<CameraModel> camera_of(Size size, double distance_mm, double mm_per_pixel, const LensSettings& lens,
                              const PoseSettings& pose, double height_mm) {
  CameraModel camera;
  camera.size = size;
  camera.fx = camera.fy = distance_mm / mm_per_pixel;
  camera.cx = (size.width - 1) / 2.0 + lens.offset_x_px;
  camera.cy = (size.height - 1) / 2.0 + lens.offset_y_px;
  camera.k1 = lens.k1, camera.k2 = lens.k2, camera.k3 = lens.k3;
  camera.p1 = lens.p1, camera.p2 = lens.p2;

  const Mat3 tilted = tilt_matrix(radians(pose.tilt_deg), radians(pose.azimuth_deg));
  const Vec3 right = column(tilted, 0), up = column(tilted, 1), back = column(tilted, 2);
  const double c = std::cos(radians(pose.roll_deg)), s = std::sin(radians(pose.roll_deg));
  const Vec3 kNoMinusZero;
  const Vec3 axes[] = {c * right - s * up + kNoMinusZero, -s * right - c * up + kNoMinusZero,
                       -1.0 * back + kNoMinusZero};
  for (std::size_t i = 0; i < 3; ++i) camera.camera_from_rig_rotation[i] = {axes[i].x, axes[i].y, axes[i].z};
  const Vec3 centre_mm = Vec3{pose.x_mm, pose.y_mm, 0} + distance_mm * back;
  camera.camera_from_rig_translation_mm = -1.0 * (camera.camera_from_rig_rotation * centre_mm) + kNoMinusZero;
  if (Result<void> ok = check_camera(camera, height_mm); !ok) return ok.error();
  return camera;
}

Result<void> check_camera(const CameraModel& camera, double height_mm) {
  const Result<Lens> lens = Lens::of(camera);
  if (!lens) return lens.error();
  for (int i = 0; i <= kStepsAlongEdge; ++i) {
    const double x = (camera.size.width - 1.0) * i / kStepsAlongEdge;
    const double y = (camera.size.height - 1.0) * i / kStepsAlongEdge;
    const double right = camera.size.width - 1, bottom = camera.size.height - 1;
    for (const auto& [px, py] : {std::pair{x, 0.0}, {x, bottom}, {0.0, y}, {right, y}}) {
      const CameraRay ray = lens->ray(px, py);
      if (ray.origin_mm.z > height_mm && ray.direction.z <= -kLeastSine) continue;
      return refusal(
          "the camera does not see the table",
          fmt::format("the ray of pixel {:.0f}, {:.0f} does not meet the plane z = {} mm", px, py, height_mm),
          "tilt it less or raise it");
    }
  }
  return {};
}

Lens::Lens(const CameraModel& camera)
    : camera_(camera),
      is_distorted_(camera.k1 != 0 || camera.k2 != 0 || camera.k3 != 0 || camera.p1 != 0 || camera.p2 != 0),
      ideal_radius_(std::numeric_limits<double>::infinity()) {
  centre_mm_ = centre_of(camera);
}

Result<Lens> Lens::of(const CameraModel& camera) {
  Lens lens(camera);
  if (!lens.is_distorted_) return lens;
  const double far_x = std::max(camera.cx, camera.size.width - 1 - camera.cx) + kRayMargin;
  const double far_y = std::max(camera.cy, camera.size.height - 1 - camera.cy) + kRayMargin;
  const double corner = std::hypot(far_x / camera.fx, far_y / camera.fy);
  // |f(p)| is at least L r - 3 |q| r^2, which grows with r by least_stretch or more.
  const double q = std::hypot(camera.p1, camera.p2);
  double radius = 0, reach = 0;
  while (reach < corner) {
    radius += corner / kStepsToCorner;
    if (!(lens.least_stretch(radius) >= kLeastStretch))
      return refusal("the lens folds the picture",
                     fmt::format("{:.3f} focal lengths from the axis its distortion may turn back; the "
                                 "frame's corner is at {:.3f}",
                                 radius, corner),
                     "use weaker coefficients k1, k2, k3, p1, p2");
    const double s = radius * radius;
    reach = radius * (1 + s * (camera.k1 + s * (camera.k2 + s * camera.k3))) - 3 * q * s;
  }
  lens.ideal_radius_ = radius;
  return lens;
}

/// A lower bound of the Jacobian's eigenvalues at a distance from the axis: L and L + 2 s L' of the radial
/// part, and at least -6 |q| r of the tangential one.
double Lens::least_stretch(double radius) const {
  const CameraModel& c = camera_;
  const double s = radius * radius;
  const double across = 1 + s * (c.k1 + s * (c.k2 + s * c.k3));
  const double along = 1 + s * (3 * c.k1 + s * (5 * c.k2 + s * 7 * c.k3));
  return std::min(across, along) - 6 * std::hypot(c.p1, c.p2) * radius;
}

Lens::Distorted Lens::distorted(Point p) const {
  const CameraModel& c = camera_;
  const double s = p.x * p.x + p.y * p.y, qp = c.p2 * p.x + c.p1 * p.y;
  const double radial = 1 + s * (c.k1 + s * (c.k2 + s * c.k3));
  const double slope = 2 * (c.k1 + s * (2 * c.k2 + s * 3 * c.k3));
  return {{(radial + 2 * qp) * p.x + s * c.p2, (radial + 2 * qp) * p.y + s * c.p1},
          radial + slope * p.x * p.x + 2 * qp + 4 * c.p2 * p.x,
          slope * p.x * p.y + 2 * (c.p2 * p.y + c.p1 * p.x),
          radial + slope * p.y * p.y + 2 * qp + 4 * c.p1 * p.y};
}

Lens::Point Lens::undistorted(Point seen) const {
  const auto inside = [this](Point p) {
    const double s = p.x * p.x + p.y * p.y;
    if (s <= ideal_radius_ * ideal_radius_) return p;
    const double scale = ideal_radius_ / std::sqrt(s);
    return Point{scale * p.x, scale * p.y};
  };
  Point p = inside(seen), before = p;
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMostNewtonSteps; ++i) {
    const Distorted d = distorted(p);
    const double ex = d.at.x - seen.x, ey = d.at.y - seen.y, error = ex * ex + ey * ey;
    if (error >= smallest) {  // a step too far: half-way back
      p = {(before.x + p.x) / 2, (before.y + p.y) / 2};
      continue;
    }
    smallest = error;
    before = p;
    const double per_det = 1 / (d.xx * d.yy - d.xy * d.xy);
    p = inside({p.x - (d.yy * ex - d.xy * ey) * per_det, p.y - (d.xx * ey - d.xy * ex) * per_det});
    if (error < kLastResidual * kLastResidual) break;
  }
  return p;
}

Vec3 Lens::towards(double x, double y) const {
  Point p = {(x - camera_.cx) / camera_.fx, (y - camera_.cy) / camera_.fy};
  if (is_distorted_) p = undistorted(p);
  const Mat3& r = camera_.camera_from_rig_rotation;
  return {r[0][0] * p.x + r[1][0] * p.y + r[2][0], r[0][1] * p.x + r[1][1] * p.y + r[2][1],
          r[0][2] * p.x + r[1][2] * p.y + r[2][2]};
}

CameraRay Lens::ray(double x, double y) const {
  const Vec3 d = towards(x, y);
  return {centre_mm_, (1 / std::sqrt(dot(d, d))) * d};
}

Vec3 Lens::point_on_plane(double x, double y, double height_mm) const {
  const Vec3 d = towards(x, y);
  const double s = (height_mm - centre_mm_.z) / d.z;
  return {centre_mm_.x + s * d.x, centre_mm_.y + s * d.y, height_mm};
}

std::optional<PicturePoint> Lens::picture_point(Vec3 point_mm) const {
  const Vec3 c = camera_.camera_from_rig_rotation * point_mm + camera_.camera_from_rig_translation_mm;
  if (!(c.z > 0)) return std::nullopt;
  Point p = {c.x / c.z, c.y / c.z};
  if (!(p.x * p.x + p.y * p.y <= ideal_radius_ * ideal_radius_)) return std::nullopt;
  if (is_distorted_) p = distorted(p).at;
  return PicturePoint{camera_.cx + camera_.fx * p.x, camera_.cy + camera_.fy * p.y, c.z};
}

}  // namespace weft::simulator
