// SPDX-License-Identifier: Apache-2.0
#include "simulator/geometry/scene_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/vec.h"

namespace weft::simulator {
namespace {

BaseSurface base_of(const GeometrySettings& g) {
  const TablePlane level({0, 0, 1});
  switch (g.kind) {
    case GeometryKind::kFlat:
      return level;
    case GeometryKind::kTilted: {
      const double tilt = radians(g.tilt_deg), azimuth = radians(g.azimuth_deg);
      return TablePlane(
          {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)});
    }
    case GeometryKind::kPlain:
    case GeometryKind::kTwill:
    case GeometryKind::kSatin:
      return Weave(g);
    case GeometryKind::kKnit:
      return Knit(g);
    case GeometryKind::kSphere:
      return Sphere(g.radius_mm, g.contact_deg);
    case GeometryKind::kCylinder:
      return Cylinder(g.radius_mm, g.contact_deg, g.azimuth_deg);
    case GeometryKind::kHeightMap:
      if (g.heights_mm && !g.heights_mm->empty()) return HeightMap(g.heights_mm, g.height_map);
      return level;
  }
  return level;
}

}  // namespace

Drape::Drape(std::span<const Fold> folds, std::span<const Wave> waves) {
  const auto add = [&](double amplitude_mm, double sharpness, double wavelength_mm, double direction_deg,
                       double start_deg) {
    const double k = 2 * kPi / wavelength_mm, direction = radians(direction_deg);
    ridges_.push_back(
        {amplitude_mm, sharpness, k * std::cos(direction), k * std::sin(direction), radians(start_deg)});
  };
  for (const Fold& f : folds) add(f.amplitude_mm, f.sharpness, f.wavelength_mm, f.direction_deg, 0);
  for (const Wave& w : waves) add(w.amplitude_mm, 0, w.wavelength_mm, w.direction_deg, w.phase_deg);
}

Drape::Lift Drape::at(double x_mm, double y_mm) const {
  Lift sum;
  for (const Ridges& r : ridges_) {
    const double phase = r.kx * x_mm + r.ky * y_mm + r.start;
    const double sine = std::sin(phase), cosine = std::cos(phase);
    const double crest = r.amplitude_mm * std::exp(r.sharpness * (cosine - 1));  // the amplitude of a wave
    const double by_phase = r.sharpness > 0 ? -r.sharpness * sine * crest : crest * cosine;
    sum.height_mm += r.sharpness > 0 ? crest : crest * sine;
    sum.slope_x += r.kx * by_phase;
    sum.slope_y += r.ky * by_phase;
  }
  return sum;
}

HeightRange Drape::heights_mm() const {
  HeightRange sum;
  for (const Ridges& r : ridges_) {
    const double crest = r.amplitude_mm;
    const double trough = r.sharpness > 0 ? crest * std::exp(-2 * r.sharpness) : -crest;
    sum.lowest_mm += std::min(crest, trough);
    sum.highest_mm += std::max(crest, trough);
  }
  return sum;
}

double Drape::steepest_slope() const {
  double sum = 0;
  for (const Ridges& r : ridges_) {
    double by_phase = 1;
    if (const double s = r.sharpness; s > 0) {  // steepest where sharpness sin^2 = cos
      const double cosine = 2 * s / (1 + std::sqrt(1 + 4 * s * s));
      by_phase = s * std::sqrt(1 - cosine * cosine) * std::exp(s * (cosine - 1));
    }
    sum += std::abs(r.amplitude_mm) * std::hypot(r.kx, r.ky) * by_phase;
  }
  return sum;
}

Draped::Draped(BaseSurface base, Drape drape) : base_(std::move(base)), drape_(std::move(drape)) {}

SurfacePoint Draped::at(double x_mm, double y_mm) const {
  SurfacePoint p = std::visit([&](const auto& base) { return base.at(x_mm, y_mm); }, base_);
  const Drape::Lift lift = drape_.at(x_mm, y_mm);
  p.height_mm += lift.height_mm;
  p.normal = normal_of_slopes(lift.slope_x - p.normal.x / p.normal.z, lift.slope_y - p.normal.y / p.normal.z);
  return p;
}

HeightRange Draped::heights_mm(const Area& area) const {
  const HeightRange base = std::visit([&](const auto& b) { return b.heights_mm(area); }, base_);
  const HeightRange lift = drape_.heights_mm();
  return {base.lowest_mm + lift.lowest_mm, base.highest_mm + lift.highest_mm};
}

double Draped::steepest_slope() const {
  return std::visit([](const auto& base) { return base.steepest_slope(); }, base_) + drape_.steepest_slope();
}

Surface surface_of(const GeometrySettings& g) {
  BaseSurface base = base_of(g);
  if (!g.folds.empty() || !g.waves.empty()) return Draped(std::move(base), Drape(g.folds, g.waves));
  return std::visit([](auto& b) -> Surface { return std::move(b); }, base);
}

SurfacePoint point_at(const Surface& surface, double x_mm, double y_mm) {
  return std::visit([&](const auto& s) { return s.at(x_mm, y_mm); }, surface);
}

HeightRange heights_mm(const Surface& surface, const Area& area) {
  return std::visit([&](const auto& s) { return s.heights_mm(area); }, surface);
}

std::optional<Period> period_mm(const Surface& surface) {
  return std::visit([](const auto& s) { return s.period_mm(); }, surface);
}

double steepest_slope(const Surface& surface) {
  return std::visit([](const auto& s) { return s.steepest_slope(); }, surface);
}

}  // namespace weft::simulator
