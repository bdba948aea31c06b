// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/fibre_cones.h"

#include <algorithm>
#include <cmath>

#include "simulator/reflectance/directions.h"

namespace weft::simulator {
namespace {

// A direction about a fibre.
struct AboutFibre {
  AboutFibre(Vec3 direction, Vec3 fibre)
      : theta(std::asin(std::clamp(dot(direction, fibre), -1.0, 1.0))),
        across(direction - dot(direction, fibre) * fibre) {}
  double theta;
  Vec3 across;
};

double half_azimuth_cosine(Vec3 a, Vec3 b) {
  const double lengths = std::max(length(a) * length(b), 1e-12);
  return std::sqrt(std::max(0.0, (1 + std::clamp(dot(a, b) / lengths, -1.0, 1.0)) / 2));
}

double gaussian(double x, double sigma) {
  return std::exp(-x * x / (2 * sigma * sigma)) / (sigma * std::sqrt(2 * kPi));
}

}  // namespace

Rgb FibreCones::evaluate(const Rgb& albedo, Vec3 l, Vec3 to_view) const {
  if (!(l.z > 0)) return {};
  constexpr double kGrazing = 1e-4;
  const Vec3 v = above_horizon(to_view);
  const Vec3 fibre = {std::cos(radians(twist_deg)), std::sin(radians(twist_deg)), 0};
  const AboutFibre in(l, fibre), out(v, fibre);
  const double theta_h = (in.theta + out.theta) / 2, theta_d = (out.theta - in.theta) / 2;
  const double cone = gaussian(theta_h - radians(tilt_deg), std::max(kSmallestAlpha, radians(spread_deg)));
  const double round = half_azimuth_cosine(in.across, out.across) / 4;
  const double squared = std::max(std::cos(theta_d) * std::cos(theta_d), kGrazing);
  const double seen = 1 / (2 * std::max(l.z + v.z - l.z * v.z, kGrazing));
  return lobe_over_diffuse(cone * round * seen / squared, f0, beneath, albedo,
                           {l.z, v.z, facet_between(l, v).cosine});
}

}  // namespace weft::simulator
