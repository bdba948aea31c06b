// SPDX-License-Identifier: Apache-2.0
#include "simulator/geometry/drape.h"

#include <algorithm>
#include <cmath>

#include "core/base/vec.h"

namespace weft::simulator {

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

}  // namespace weft::simulator
