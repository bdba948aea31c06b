// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/statistics.h"
#include "material/validation/checks.h"

namespace weft::material {
namespace {

double most_channel(const Checked& checked, int x, int y) {
  const auto& albedo = checked.albedo;
  return double{std::max({albedo(x, y, 0), albedo(x, y, 1), albedo(x, y, 2)})};
}

double f0_at(const Checked& checked, int x, int y) {
  return double{checked.surface().lobe(x, y, 3)};
}

// The quantile of `of`(x, y) among the pixels that count.
template <typename Of>
double quantile_of(const Checked& checked, double share, const Of& of) {
  std::vector<float> values;
  for (int y = 0; y < checked.size().height; ++y) {
    for (int x = 0; x < checked.size().width; ++x) {
      if (checked.counts(x, y) != 0) values.push_back(static_cast<float>(of(x, y)));
    }
  }
  return double{quantile(std::move(values), share)};
}

// Smith's share of facets that a direction sees, for GGX.
double smith(double alpha, Vec3 d) {
  return 2 * d.z / (d.z + std::sqrt(alpha * alpha + (1 - alpha * alpha) * d.z * d.z));
}

// A facet that is seen from v, of GGX (Heitz 2018, listing 1).
Vec3 visible_facet(double alpha, Vec3 v, double u1, double u2) {
  const Vec3 stretched = normalized({alpha * v.x, alpha * v.y, v.z});
  const double across = std::hypot(stretched.x, stretched.y);
  const Vec3 t = across > 0 ? Vec3{-stretched.y / across, stretched.x / across, 0} : Vec3{1, 0, 0};
  const Vec3 b = cross(stretched, t);
  const double r = std::sqrt(u1), phi = 2 * kPi * u2, p = r * std::cos(phi), s = (1 + stretched.z) / 2;
  const double q = (1 - s) * std::sqrt(1 - p * p) + s * r * std::sin(phi);
  const Vec3 h = p * t + q * b + std::sqrt(std::max(0.0, 1 - p * p - q * q)) * stretched;
  return normalized({alpha * h.x, alpha * h.y, std::max(h.z, 1e-9)});
}

}  // namespace

double ggx_directional_albedo(double alpha, double f0, double view_deg) {
  constexpr int kFacets = 32;
  const double a = std::clamp(alpha, 1e-3, 1.0), view = radians(std::min(view_deg, 89.9));
  const Vec3 v = {std::sin(view), 0, std::cos(view)};
  double sum = 0;
  for (int i = 0; i < kFacets; ++i) {
    for (int j = 0; j < kFacets; ++j) {
      const Vec3 h = visible_facet(a, v, (i + 0.5) / kFacets, (j + 0.5) / kFacets);
      const double cosine = dot(v, h);
      const Vec3 l = (2 * cosine) * h - v;
      if (l.z > 0) sum += (f0 + (1 - f0) * std::pow(1 - cosine, 5)) * smith(a, l);
    }
  }
  return sum / (kFacets * kFacets);
}

Finding f0_range(const Checked& checked) {
  const ValidationLimits& limits = checked.limits;
  const bool metal = checked.maps.is_metal;
  const double least = metal ? limits.least_metal_f0 : limits.least_f0, most = metal ? 1 : limits.most_f0;
  Marked outside = marked(checked, [&](int x, int y) {
    return !(f0_at(checked, x, y) >= least && f0_at(checked, x, y) <= most);
  });
  const double middle = quantile_of(checked, 0.5, [&](int x, int y) { return f0_at(checked, x, y); });
  const double share = outside.count / checked.pixels, nearest = middle < least ? least : most;
  if (share <= limits.outside_share) {
    return passed("F0", fmt::format("F0 is {:.4f} in the middle, between {:g} and {:g}", middle, least, most),
                  middle, nearest);
  }
  return failed(
      Severity::kWarning,
      {"F0",
       fmt::format("F0 of {:.1f} percent of the cloth is not between {:g} and {:g}, that of {}; its middle "
                   "is {:.4f}",
                   100 * share, least, most, metal ? "metals" : "fibres", middle),
       metal ? "type it as a dielectric"
             : "make a material of the maps and set its specular, F0 over 0.08: 0.5 for cellulose, 0.575 for "
               "wool and silk, 0.625 for polyester"},
      middle, nearest, std::move(outside.where));
}

Finding energy(const Checked& checked) {
  const double limit = checked.limits.energy;
  const auto reflected = [&](int x, int y) { return most_channel(checked, x, y) + f0_at(checked, x, y); };
  const double number = quantile_of(checked, 1 - checked.limits.outside_share, reflected);
  if (number <= limit) {
    return passed("ENERGY", fmt::format("albedo and F0 come to {:.3f} at most", number), number, limit);
  }
  Marked over = marked(checked, [&](int x, int y) { return reflected(x, y) > limit; });
  return failed(
      Severity::kError,
      {"ENERGY",
       fmt::format("albedo and F0 come to {:.3f}: {:.1f} percent of the cloth reflects more light than "
                   "falls on it",
                   number, 100 * over.count / checked.pixels),
       checked.maps.is_colour_changed ? "take a smaller exposure or gain in the step color"
                                      : "check the white patch of the calibration and its reflectance"},
      number, limit, std::move(over.where));
}

Finding lobe_energy(const Checked& checked) {
  const double limit = checked.limits.energy;
  const auto middle = [&](int plane) {
    return quantile_of(checked, 0.5,
                       [&](int x, int y) { return double{checked.surface().lobe(x, y, plane)}; });
  };
  const double alpha = std::sqrt(std::max(middle(0) * middle(1), 0.0));
  const double f0 = std::clamp(middle(3), 0.0, 1.0);
  const double lobe = std::max(ggx_directional_albedo(alpha, f0, 0), ggx_directional_albedo(alpha, f0, 60));
  const auto reflected = [&](int x, int y) { return most_channel(checked, x, y) + lobe; };
  const double number = quantile_of(checked, 1 - checked.limits.outside_share, reflected);
  if (number <= limit) {
    return passed("LOBE_ENERGY",
                  fmt::format("albedo and lobe reflect {:.3f} at most, the lobe {:.3f}", number, lobe),
                  number, limit);
  }
  Marked over = marked(checked, [&](int x, int y) { return reflected(x, y) > limit; });
  return failed(
      Severity::kWarning,
      {"LOBE_ENERGY", fmt::format("added up, albedo and a lobe of {:.3f} reflect {:.3f}", lobe, number),
       "leave it where the engine takes the lobe's share from the diffuse part"},
      number, limit, std::move(over.where));
}

}  // namespace weft::material
