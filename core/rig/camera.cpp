// SPDX-License-Identifier: Apache-2.0
#include "core/rig/camera.h"

#include <cmath>

namespace weft {
namespace {

struct Point2 {
  double x, y;
};

// Brown-Conrady: where the lens puts a point of the ideal image plane (focal length 1).
Point2 distort(const CameraModel& c, Point2 p) {
  const double r2 = p.x * p.x + p.y * p.y;
  const double radial = 1 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  return {p.x * radial + 2 * c.p1 * p.x * p.y + c.p2 * (r2 + 2 * p.x * p.x),
          p.y * radial + c.p1 * (r2 + 2 * p.y * p.y) + 2 * c.p2 * p.x * p.y};
}

// Newton's method with a numerical Jacobian; two to four steps for any lens a scanner would use.
Point2 undistort(const CameraModel& c, Point2 seen) {
  if (c.k1 == 0 && c.k2 == 0 && c.k3 == 0 && c.p1 == 0 && c.p2 == 0) return seen;
  constexpr double kStep = 1e-6;
  Point2 p = seen;
  for (int i = 0; i < 20; ++i) {
    const Point2 f = distort(c, p);
    const Point2 error = {f.x - seen.x, f.y - seen.y};
    if (std::hypot(error.x, error.y) < 1e-13) break;
    const Point2 fx = distort(c, {p.x + kStep, p.y});
    const Point2 fy = distort(c, {p.x, p.y + kStep});
    const double a = (fx.x - f.x) / kStep, b = (fy.x - f.x) / kStep;
    const double d = (fx.y - f.y) / kStep, e = (fy.y - f.y) / kStep;
    const double det = a * e - b * d;
    p.x -= (e * error.x - b * error.y) / det;
    p.y -= (a * error.y - d * error.x) / det;
  }
  return p;
}

Vec3 times_transposed(const Mat3& m, Vec3 v) {
  return {m[0][0] * v.x + m[1][0] * v.y + m[2][0] * v.z, m[0][1] * v.x + m[1][1] * v.y + m[2][1] * v.z,
          m[0][2] * v.x + m[1][2] * v.y + m[2][2] * v.z};
}

}  // namespace

CameraModel overhead_camera(Size size, double distance_mm, double mm_per_pixel) {
  CameraModel camera;
  camera.size = size;
  camera.fx = camera.fy = distance_mm / mm_per_pixel;
  camera.cx = (size.width - 1) / 2.0;
  camera.cy = (size.height - 1) / 2.0;
  camera.camera_from_rig_translation_mm = {0, 0, distance_mm};
  return camera;
}

Vec3 centre_of(const CameraModel& camera) {
  return -1.0 * times_transposed(camera.camera_from_rig_rotation, camera.camera_from_rig_translation_mm);
}

Vec3 point_on_plane(const CameraModel& camera, double x, double y, double height_mm) {
  const Point2 p = undistort(camera, {(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy});
  const Vec3 ray = times_transposed(camera.camera_from_rig_rotation, {p.x, p.y, 1});
  const Vec3 centre = centre_of(camera);
  const double s = (height_mm - centre.z) / ray.z;
  return {centre.x + s * ray.x, centre.y + s * ray.y, height_mm};
}

Vec3 project(const CameraModel& camera, Vec3 point) {
  const Vec3 c = camera.camera_from_rig_rotation * point + camera.camera_from_rig_translation_mm;
  const Point2 p = distort(camera, {c.x / c.z, c.y / c.z});
  return {camera.cx + camera.fx * p.x, camera.cy + camera.fy * p.y, c.z};
}

}  // namespace weft
