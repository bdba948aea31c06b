// SPDX-License-Identifier: Apache-2.0
#include "simulator/targets/table_ball.h"

#include <algorithm>
#include <cmath>

namespace weft::simulator {
namespace {

constexpr double kChromeShare = 0.6, kGlassShare = 0.04;
constexpr int kRaysAcross = 8;

/// The place nearest to the centre along a ray.
struct Approach {
  double along_mm;
  double beside_mm;
};
Approach approach(const BallSettings& ball, Vec3 origin_mm, Vec3 unit) {
  const Vec3 to_centre = ball.centre_mm - origin_mm;
  const double along = dot(to_centre, unit);
  return {along, length(to_centre - along * unit)};
}

/// On the surface, or of a ray that passes it by where that is nearest.
Vec3 normal_at(const BallSettings& ball, Vec3 origin_mm, Vec3 unit, const Approach& a) {
  const double inside = ball.radius_mm * ball.radius_mm - a.beside_mm * a.beside_mm;
  const double along = a.along_mm - std::sqrt(std::max(inside, 0.0));
  return normalized(origin_mm + along * unit - ball.centre_mm);
}

/// Where a ray is sent, and how squarely it meets the ball.
struct Mirrored {
  Vec3 direction;
  double facing;
};
std::optional<Mirrored> mirrored_ray(const BallSettings& ball, Vec3 origin_mm, Vec3 unit) {
  const Approach a = approach(ball, origin_mm, unit);
  if (a.beside_mm >= ball.radius_mm) return std::nullopt;
  const Vec3 normal = normal_at(ball, origin_mm, unit, a);
  const double facing = -dot(unit, normal);
  return Mirrored{unit + 2 * facing * normal, facing};
}

/// Whether no ray of a pixel is sent near enough to a lamp for it to count.
bool is_dark(const BallSettings& ball, const ViewRay& ray, Vec3 to_light) {
  const Vec3 unit = normalized(ray.direction);
  const std::optional<Mirrored> middle = mirrored_ray(ball, ray.origin_mm, unit);
  if (!middle || middle->facing < 0.2) return false;
  const double pixel_mm =
      approach(ball, ray.origin_mm, unit).along_mm * length(ray.per_x) / length(ray.direction);
  const double turn = 2 * pixel_mm / (ball.radius_mm * middle->facing);
  return radians(angle_deg(middle->direction, to_light)) > 7 * radians(ball.highlight_deg) + 2 * turn;
}

}  // namespace

std::optional<BallHit> hit(const BallSettings& ball, const ViewRay& ray) {
  const Vec3 unit = normalized(ray.direction);
  const Approach a = approach(ball, ray.origin_mm, unit);
  if (!(a.along_mm > ball.radius_mm)) return std::nullopt;
  const double pixel_mm = a.along_mm * length(ray.per_x) / length(ray.direction);
  const double depth = ball.radius_mm - a.beside_mm;
  const double coverage = pixel_mm > 0 ? std::clamp(depth / pixel_mm + 0.5, 0.0, 1.0) : depth > 0 ? 1 : 0;
  if (!(coverage > 0)) return std::nullopt;
  const Vec3 normal = normal_at(ball, ray.origin_mm, unit, a);
  return BallHit{ball.centre_mm + ball.radius_mm * normal, normal, coverage};
}

double mirrored(const BallSettings& ball, const ViewRay& ray, Vec3 to_light) {
  if (ball.surface == BallSurface::kMatt || is_dark(ball, ray, to_light)) return 0;
  const double width = radians(ball.highlight_deg);
  double sum = 0;
  for (int j = 0; j < kRaysAcross; ++j) {
    for (int i = 0; i < kRaysAcross; ++i) {
      const double dx = (i + 0.5) / kRaysAcross - 0.5, dy = (j + 0.5) / kRaysAcross - 0.5;
      const Vec3 unit = normalized(ray.direction + dx * ray.per_x + dy * ray.per_y);
      const std::optional<Mirrored> sent = mirrored_ray(ball, ray.origin_mm, unit);
      if (!sent) continue;
      const double angle = radians(angle_deg(sent->direction, to_light));
      const double share = ball.surface == BallSurface::kChrome
                               ? kChromeShare
                               : kGlassShare + (1 - kGlassShare) * std::pow(1 - sent->facing, 5);
      sum += share * std::exp(-angle * angle / (2 * width * width)) / (2 * width * width);
    }
  }
  return sum / (kRaysAcross * kRaysAcross);
}

}  // namespace weft::simulator
