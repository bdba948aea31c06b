// SPDX-License-Identifier: Apache-2.0
#include "calibration/ball/outline.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/base/statistics.h"
#include "core/base/vec.h"

namespace weft::calibration {
namespace {

constexpr double kStep_px = 0.5;       // between samples of a ray
constexpr double kLeastWindow_px = 4;  // edges are looked for this far from a circle at least
constexpr double kClosest_px = 2.5;    // and in the end
constexpr double kLeastSupport = 0.25;
constexpr double kTukey = 4.685;
constexpr std::size_t kMostOnRay = 3;
constexpr double kWeakest = 0.2;  // of the steepest of its ray
constexpr int kTries = 500;
constexpr double kAgrees_px = 0.6;
constexpr double kMostScatter = 0.025;  // of the radius, of an edge that is an outline
constexpr double kLeastSigma_px = 0.02;

float value_at(View<const float> picture, double x, double y) {
  x = std::clamp(x, 0.0, picture.width() - 1.001);
  y = std::clamp(y, 0.0, picture.height() - 1.001);
  const int ix = static_cast<int>(x), iy = static_cast<int>(y);
  const auto fx = static_cast<float>(x - ix), fy = static_cast<float>(y - iy);
  const int nx = std::min(ix + 1, picture.width() - 1), ny = std::min(iy + 1, picture.height() - 1);
  return (1 - fy) * ((1 - fx) * picture(ix, iy) + fx * picture(nx, iy)) +
         fy * ((1 - fx) * picture(ix, ny) + fx * picture(nx, ny));
}

bool is_inside(View<const float> picture, double x, double y) {
  return x >= 0 && y >= 0 && x <= picture.width() - 1 && y <= picture.height() - 1;
}

/// Where a ray from a circle's centre meets an edge.
struct RayEdge {
  int ray = 0;
  double angle = 0, radius = 0, strength = 0;
};

int rays_about(const Circle& circle) {
  return std::clamp(static_cast<int>(2 * kPi * circle.radius), 90, 720);
}

/// Adds the places where a ray is steeper than about them, the steepest first, and at most kMostOnRay.
void add_steepest(const std::vector<double>& steep, RayEdge ray, double from, std::vector<RayEdge>& edges) {
  std::vector<RayEdge> found;
  for (std::size_t i = 1; i + 1 < steep.size(); ++i) {
    const double before = steep[i - 1], here = steep[i], after = steep[i + 1];
    if (!(here > 0) || here < before || here <= after) continue;
    const double bend = before - 2 * here + after;
    const double shift = std::clamp(0.5 * (before - after) / bend, -0.5, 0.5);
    ray.radius = from + (static_cast<double>(i) + shift) * kStep_px;
    ray.strength = here;
    found.push_back(ray);
  }
  std::ranges::sort(found, std::greater(), &RayEdge::strength);
  for (std::size_t i = 0; i < std::min(found.size(), kMostOnRay); ++i) {
    if (found[i].strength > kWeakest * found.front().strength) edges.push_back(found[i]);
  }
}

/// The steepest places of each of `pictures` along rays within `window` of the circle, by rays.
std::vector<RayEdge> edges_about(std::span<const View<const float>> pictures, const Circle& circle,
                                 double window) {
  const int rays = rays_about(circle);
  const int half = std::max(2, static_cast<int>(std::ceil(window / kStep_px)));
  const int samples = 2 * half + 1;
  std::vector<RayEdge> edges;
  std::vector<double> steep(static_cast<std::size_t>(samples));
  std::vector<double> profile(static_cast<std::size_t>(samples + 8));
  for (int a = 0; a < rays; ++a) {
    const double angle = 2 * kPi * a / rays, c = std::cos(angle), s = std::sin(angle);
    for (const View<const float>& picture : pictures) {
      bool whole = true;
      for (std::size_t i = 0; i < profile.size(); ++i) {
        const double r = circle.radius + (static_cast<double>(i) - 4 - half) * kStep_px;
        const double x = circle.x + r * c, y = circle.y + r * s;
        whole = whole && is_inside(picture, x, y);
        profile[i] = value_at(picture, x, y);
      }
      // A derivative of a Gaussian of one pixel.
      constexpr double kWeights[] = {0.441, 0.607, 0.487, 0.271};
      for (std::size_t i = 0; i < steep.size(); ++i) {
        double d = 0;
        for (std::size_t k = 1; k <= 4; ++k) d += kWeights[k - 1] * (profile[i + 4 + k] - profile[i + 4 - k]);
        steep[i] = std::abs(d);
      }
      if (whole) add_steepest(steep, {a, angle, 0, 0}, circle.radius - half * kStep_px, edges);
    }
  }
  return edges;
}

double tukey(double residual, double scale) {
  const double t = residual / (kTukey * scale);
  return std::abs(t) < 1 ? (1 - t * t) * (1 - t * t) : 0;
}

double scale_of(const std::vector<double>& residuals, double least) {
  std::vector<double> sizes;
  for (const double r : residuals) sizes.push_back(std::abs(r));
  return std::max(1.4826 * median(sizes), least);
}

using Point = std::array<double, 2>;

/// An edge's place, of several on one ray the one nearest to the circle.
struct Edges {
  std::vector<RayEdge> edges;
  std::vector<Point> points;

  Edges(std::vector<RayEdge> all, const Circle& about) : edges(std::move(all)) {
    for (const RayEdge& e : edges)
      points.push_back({about.x + e.radius * std::cos(e.angle), about.y + e.radius * std::sin(e.angle)});
  }
  /// One a ray: its place and how far it lies beyond the circle.
  std::vector<std::pair<Point, double>> nearest_to(const Circle& circle) const {
    std::vector<std::pair<Point, double>> nearest;
    int ray = -1;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const double off = std::hypot(points[i][0] - circle.x, points[i][1] - circle.y) - circle.radius;
      if (edges[i].ray != ray) {
        nearest.emplace_back(points[i], off);
      } else if (std::abs(off) < std::abs(nearest.back().second)) {
        nearest.back() = {points[i], off};
      }
      ray = edges[i].ray;
    }
    return nearest;
  }
  std::ptrdiff_t agreeing(const Circle& circle, double within_px) const {
    return std::ranges::count_if(nearest_to(circle),
                                 [&](const auto& e) { return std::abs(e.second) < within_px; });
  }
};

std::optional<Circle> circle_through(const Point& a, const Point& b, const Point& c) {
  const double bx = b[0] - a[0], by = b[1] - a[1], cx = c[0] - a[0], cy = c[1] - a[1];
  const double d = 2 * (bx * cy - by * cx);
  if (std::abs(d) < 1e-6) return std::nullopt;
  const double bb = bx * bx + by * by, cc = cx * cx + cy * cy;
  const double x = (cy * bb - by * cc) / d, y = (bx * cc - cx * bb) / d;
  return Circle{a[0] + x, a[1] + y, std::hypot(x, y)};
}

/// The circle that most rays agree with, of those through three edges (RANSAC, the same tries each time).
std::optional<Circle> agreed_circle(const Edges& edges, const Circle& about) {
  const std::size_t count = edges.points.size();
  if (count < 12) return std::nullopt;
  std::uint32_t state = 12345;
  const auto next = [&] {
    state = state * 1664525U + 1013904223U;
    return static_cast<std::size_t>(state >> 8) % count;
  };
  std::optional<Circle> best;
  std::ptrdiff_t most = 0;
  for (int i = 0; i < kTries; ++i) {
    const std::optional<Circle> circle =
        circle_through(edges.points[next()], edges.points[next()], edges.points[next()]);
    if (!circle || std::hypot(circle->x - about.x, circle->y - about.y) > 0.3 * about.radius ||
        std::abs(circle->radius / about.radius - 1) > 0.3)
      continue;
    const std::ptrdiff_t agree = edges.agreeing(*circle, kAgrees_px);
    if (agree <= most) continue;
    most = agree;
    best = circle;
  }
  return best;
}

/// A circle fitted to edges near it, and how they scatter, px.
struct Fit {
  Circle circle;
  double scale = 0;
  double used = 0;      ///< sum of weights
  double sigma_px = 0;  ///< of its centre, along the worse axis
};
/// Gauss-Newton on distances to the circle with Tukey's weights.
std::optional<Fit> fitted_circle(const Edges& edges, const Circle& start) {
  Fit fit = {start, 0, 0, 0};
  for (int i = 0; i < 30; ++i) {
    auto nearest = edges.nearest_to(fit.circle);
    std::erase_if(nearest, [](const auto& e) { return std::abs(e.second) > kClosest_px; });
    std::vector<double> residuals;
    for (const auto& e : nearest) residuals.push_back(e.second);
    if (residuals.size() < 12) return std::nullopt;
    fit.scale = std::min(scale_of(residuals, 0.05), kAgrees_px / 2);
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    fit.used = 0;
    for (const auto& [point, residual] : nearest) {
      const double w = tukey(residual, fit.scale);
      const double dx = point[0] - fit.circle.x, dy = point[1] - fit.circle.y, d = std::hypot(dx, dy);
      const Eigen::Vector3d j(dx / d, dy / d, 1);
      a += w * j * j.transpose();
      b += w * residual * j;
      fit.used += w;
    }
    if (fit.used < 8 || !(std::abs(a.determinant()) > 1e-6 * std::pow(fit.used, 3))) return std::nullopt;
    const Eigen::Vector3d step = a.ldlt().solve(b);
    fit.circle.x += step[0];
    fit.circle.y += step[1];
    fit.circle.radius += step[2];
    const Eigen::Matrix3d covariance = a.inverse();
    fit.sigma_px = fit.scale * std::sqrt(std::max(covariance(0, 0), covariance(1, 1)));
    if (step.norm() < 1e-6) break;
  }
  return fit;
}

double tolerance_of(const Circle& circle) {
  return std::max(0.8, 0.01 * circle.radius);
}

/// Share of the directions in which the strongest edge within `window` is the circle's, less chance.
double support_of(std::span<const View<const float>> pictures, const Circle& circle) {
  const double window = std::max(kLeastWindow_px, 0.12 * circle.radius), tolerance = tolerance_of(circle);
  const std::vector<RayEdge> edges = edges_about(pictures, circle, window);
  const int rays = rays_about(circle);
  int near = 0, ray = -1;  // the first of a ray is its steepest
  for (const RayEdge& e : edges) {
    if (e.ray != ray && std::abs(e.radius - circle.radius) <= tolerance) ++near;
    ray = e.ray;
  }
  const double chance = tolerance / window;
  return (static_cast<double>(near) / rays - chance) / (1 - chance);
}

/// Whether a shot shows the outline where it is said to have moved to, and not as well where it was.
bool is_there_instead(const Edges& edges, const Circle& circle, const OutlineShift& shift) {
  const double within_px = std::max(kAgrees_px, 0.015 * circle.radius);
  const std::ptrdiff_t there =
      edges.agreeing({circle.x + shift.x, circle.y + shift.y, circle.radius}, within_px);
  if (2 * there < rays_about(circle)) return false;
  return std::hypot(shift.x, shift.y) < 2 * within_px || there > 2 * edges.agreeing(circle, within_px);
}

}  // namespace

SharedPictures shared_pictures(std::span<const Image<float>> shots) {
  const Size size = shots.front().size();
  SharedPictures shared = {Image<float>(size), Image<float>(size), Image<float>(size)};
  std::vector<float> values(shots.size());
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      double mean = 0;
      for (std::size_t k = 0; k < shots.size(); ++k) {
        values[k] = std::clamp(shots[k](x, y), 0.0F, 1.0F);
        mean += values[k];
      }
      shared.mean(x, y) = static_cast<float>(mean / static_cast<double>(shots.size()));
      shared.greatest(x, y) = *std::max_element(values.begin(), values.end());
      shared.median(x, y) = value_of_rank<float>(values, (values.size() - 1) / 2);
    }
  }
  return shared;
}

std::optional<Outline> fitted_outline(const SharedPictures& shared, const Circle& start, double reach) {
  const std::array<View<const float>, 2> pictures = {shared.greatest.plane(), shared.mean.plane()};
  const Edges wide(edges_about(pictures, start, std::max(kLeastWindow_px, reach * start.radius)), start);
  const std::optional<Circle> agreed = agreed_circle(wide, start);
  if (!agreed) return std::nullopt;
  const Edges close(edges_about(pictures, *agreed, 2 * kClosest_px), *agreed);
  const std::optional<Fit> fit = fitted_circle(close, *agreed);
  if (!fit) return std::nullopt;
  Outline outline;
  outline.support = support_of(pictures, fit->circle);
  if (outline.support < kLeastSupport) return std::nullopt;
  for (const auto& [point, residual] : close.nearest_to(fit->circle)) {
    if (tukey(residual, fit->scale) > 0.5) outline.edge.push_back(point);
  }
  outline.circle = fit->circle;
  // Neighbouring rays share pixels, which halves what they say at least.
  outline.sigma_px = std::max(2 * fit->sigma_px, kLeastSigma_px);
  return outline;
}

std::optional<OutlineShift> outline_shift(const Image<float>& shot, const Circle& circle) {
  const std::array<View<const float>, 1> picture = {shot.plane()};
  std::vector<RayEdge> edges =
      edges_about(picture, circle, std::max(2 * kLeastWindow_px, 0.1 * circle.radius));
  std::vector<double> strengths;
  const Edges all(edges, circle);
  int ray = -1;
  std::erase_if(edges, [&](const RayEdge& e) { return std::exchange(ray, e.ray) == e.ray; });
  for (const RayEdge& e : edges) strengths.push_back(e.strength);
  if (strengths.empty()) return std::nullopt;
  const double strong = 0.5 * quantile(strengths, 0.9);
  std::erase_if(edges, [&](const RayEdge& e) { return e.strength < strong; });
  if (edges.size() < 30 || edges.size() * 5 < strengths.size()) return std::nullopt;
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  Eigen::Matrix2d a;
  double scale = 0, used = 0;
  for (int i = 0; i < 20; ++i) {
    std::vector<double> residuals;
    for (const RayEdge& e : edges)
      residuals.push_back(e.radius - circle.radius - shift[0] * std::cos(e.angle) -
                          shift[1] * std::sin(e.angle));
    scale = scale_of(residuals, 0.05);
    a.setZero();
    Eigen::Vector2d b = Eigen::Vector2d::Zero();
    used = 0;
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const Eigen::Vector2d j(std::cos(edges[k].angle), std::sin(edges[k].angle));
      const double w = tukey(residuals[k], scale);
      a += w * j * j.transpose();
      b += w * residuals[k] * j;
      used += w;
    }
    if (std::abs(a.determinant()) < 1e-3 * used * used) return std::nullopt;
    shift += a.ldlt().solve(b);
  }
  if (scale > kMostScatter * circle.radius || used < 0.5 * static_cast<double>(edges.size()))
    return std::nullopt;
  const OutlineShift found = {shift[0], shift[1], scale};
  return is_there_instead(all, circle, found) ? std::optional(found) : std::nullopt;
}

}  // namespace weft::calibration
