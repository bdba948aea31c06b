// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/lobe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace weft::solver {
namespace {

constexpr std::array<const char*, 6> kFamilyNames = {"lambert",  "ggx",   "anisotropic-ggx",
                                                     "beckmann", "cloth", "two-ggx"};
// Cosines of light and view count as this where they are less.
constexpr double kLeastCosine = 1e-6;
// Step of the derivative of a lobe by its normal.
constexpr double kTurn = 1e-5;

double square(double v) {
  return v * v;
}

// Cosines of a normal with the directions of a light.
struct Cosines {
  double light, view, half;
};

double ggx(double alpha, const Cosines& c) {
  const double a2 = square(alpha), spread = (1 - square(c.half)) / a2 + square(c.half);
  const auto smith = [a2](double cosine) { return 1 / (cosine + std::sqrt(a2 + (1 - a2) * square(cosine))); };
  return smith(c.light) * smith(c.view) / (kPi * a2 * square(spread));
}

double anisotropic_ggx(const Lobe& lobe, Vec3 n, const LitFrom& from, double yarn, const Cosines& c) {
  const double across = lobe.alpha, along = lobe.alpha * lobe.along, azimuth = lobe.axis + yarn;
  // The yarn's direction in the surface.
  const double x = std::cos(azimuth), y = std::sin(azimuth);
  const Vec3 t = normalized({x * n.z, y * n.z, -(x * n.x + y * n.y)}), s = cross(n, t);
  const auto smith = [&](Vec3 d, double cosine) {
    return 1 / (cosine + std::sqrt(square(along * dot(d, t)) + square(across * dot(d, s)) + square(cosine)));
  };
  const double spread =
      square(dot(from.half, t) / along) + square(dot(from.half, s) / across) + square(c.half);
  return smith(from.light, c.light) * smith(from.view, c.view) / (kPi * along * across * square(spread));
}

double beckmann(double alpha, const Cosines& c) {
  const double a2 = square(alpha), h2 = square(std::max(c.half, kLeastCosine));
  const double d = std::exp(-(1 - h2) / (h2 * a2)) / (kPi * a2 * square(h2));
  const auto unshadowed = [alpha](double cosine) {
    const double q = cosine / (alpha * std::sqrt(std::max(1 - square(cosine), 1e-12)));
    const double g = (3.535 * q + 2.181 * square(q)) / (1 + 2.276 * q + 2.577 * square(q));
    return q < 1.6 ? std::min(g, 1.0) : 1.0;
  };
  return d * unshadowed(c.light) * unshadowed(c.view) / (4 * c.light * c.view);
}

double cloth(double alpha, const Cosines& c) {
  const double a2 = square(alpha), s2 = std::max(1 - square(c.half), 1e-12);
  const double cot2 = square(c.half) / s2;
  const double d = (1 + 4 * std::exp(-cot2 / a2) / square(s2)) / (kPi * (1 + 4 * a2));
  return d / (4 * std::max(c.light + c.view - c.light * c.view, 1e-4));
}

double fresnel(double f0, double light_half) {
  const double r = 1 - light_half;
  return f0 + (1 - f0) * square(square(r)) * r;
}

// Two directions across a unit vector.
std::array<Vec3, 2> tangents(Vec3 n) {
  const Vec3 aside = std::abs(n.z) > 0.5 ? Vec3{1, 0, 0} : Vec3{0, 0, 1};
  const Vec3 first = normalized(cross(aside, n));
  return {first, cross(n, first)};
}

}  // namespace

const char* name_of(LobeFamily family) {
  return kFamilyNames[static_cast<std::size_t>(family)];
}

LitFrom::LitFrom(Vec3 to_light, Vec3 to_camera, double share_of_lobe)
    : light(to_light),
      view(to_camera),
      half(normalized(to_light + to_camera)),
      light_half(dot(light, half)),
      lobe_share(share_of_lobe) {}

double f0_of(const Lobe& lobe, int channel) {
  return channel < 0 ? lobe.f0 : std::min(lobe.f0 * lobe.tint[static_cast<std::size_t>(channel)], 1.0);
}

double specular(const Lobe& lobe, Vec3 n, const LitFrom& from, double yarn) {
  const Cosines c = {std::max(dot(n, from.light), kLeastCosine), std::max(dot(n, from.view), kLeastCosine),
                     dot(n, from.half)};
  const double f = from.lobe_share * kPi * fresnel(f0_of(lobe, from.channel), from.light_half);
  switch (lobe.family) {
    case LobeFamily::kLambert:
      return 0;
    case LobeFamily::kGgx:
      return f * ggx(lobe.alpha, c);
    case LobeFamily::kAnisotropicGgx:
      return f * anisotropic_ggx(lobe, n, from, yarn, c);
    case LobeFamily::kBeckmann:
      return f * beckmann(lobe.alpha, c);
    case LobeFamily::kCloth:
      return f * cloth(lobe.alpha, c);
    case LobeFamily::kTwoGgx:
      return f * ((1 - lobe.broad_share) * ggx(lobe.alpha, c) + lobe.broad_share * ggx(lobe.broad, c));
  }
  return 0;
}

double equal_angle(const Lobe& lobe, Vec3 n, Vec3 half, double yarn) {
  const double cosine = std::clamp(dot(n, half), -1.0, 1.0);
  if (lobe.family != LobeFamily::kAnisotropicGgx || !(cosine > 0)) return std::acos(cosine);
  const double azimuth = lobe.axis + yarn, x = std::cos(azimuth), y = std::sin(azimuth);
  const Vec3 t = normalized({x * n.z, y * n.z, -(x * n.x + y * n.y)});
  return std::atan2(std::hypot(dot(half, t) / lobe.along, dot(half, cross(n, t))), cosine);
}

double relative_facets(const Lobe& lobe, double equal_angle) {
  const double cosine = std::cos(equal_angle), c2 = square(cosine), a2 = square(lobe.alpha);
  if (!(cosine > 0)) return 0;
  switch (lobe.family) {
    case LobeFamily::kLambert:
      return 0;
    case LobeFamily::kGgx:
    case LobeFamily::kAnisotropicGgx:
      return 1 / square((1 - c2) / a2 + c2);
    case LobeFamily::kBeckmann:
      return std::exp(-(1 - c2) / (c2 * a2)) / square(c2);
    case LobeFamily::kCloth: {
      const double s2 = std::max(1 - c2, 1e-12);
      return 1 + 4 * std::exp(-c2 / (s2 * a2)) / square(s2);
    }
    case LobeFamily::kTwoGgx: {
      const double sharp_peak = (1 - lobe.broad_share) / a2,
                   broad_peak = lobe.broad_share / square(lobe.broad);
      const double sharp = sharp_peak * relative_facets(lobe.sharp_part(), equal_angle),
                   broad = broad_peak * relative_facets(lobe.broad_part(), equal_angle);
      return (sharp + broad) / (sharp_peak + broad_peak);
    }
  }
  return 0;
}

double alpha_of_one(const Lobe& lobe) {
  if (lobe.family != LobeFamily::kTwoGgx) return lobe.alpha;
  return 1 / ((1 - lobe.broad_share) / lobe.alpha + lobe.broad_share / lobe.broad);
}

double modelled(const Lobe& lobe, Vec3 b, const LitFrom& from, double yarn) {
  const double rho = length(b);
  const Vec3 n = (1 / std::max(rho, 1e-12)) * b;
  const double cosine = dot(n, from.light);
  if (!(cosine > 0)) return 0;
  const double beneath = lobe.shines() ? 1 - fresnel(f0_of(lobe, from.channel), from.light_half) : 1;
  const double diffuse = rho * beneath * (1 - lobe.bend * (1 - cosine));
  return cosine * (diffuse + (lobe.shines() ? specular(lobe, n, from, yarn) : 0));
}

ModelledReading modelled_with_derivative(const Lobe& lobe, Vec3 b, const LitFrom& from, double yarn) {
  const double rho = std::max(length(b), 1e-12);
  const Vec3 n = (1 / rho) * b;
  const double cosine = dot(n, from.light);
  if (!(cosine > 0)) return {};
  const double beneath = lobe.shines() ? 1 - fresnel(f0_of(lobe, from.channel), from.light_half) : 1;
  const double straight = 1 - lobe.bend * (1 - cosine);
  ModelledReading reading;
  reading.x = cosine * rho * beneath * straight;
  // b . l is linear in b; only the bend follows the turn of the normal.
  reading.by_b = beneath * (straight * from.light + (lobe.bend * cosine) * (from.light - cosine * n));
  if (!lobe.shines()) return reading;
  const auto shine = [&](Vec3 normal) {
    return std::max(dot(normal, from.light), 0.0) * specular(lobe, normal, from, yarn);
  };
  const double here = shine(n);
  reading.x += here;
  for (const Vec3 t : tangents(n)) {
    const double slope = (shine(normalized(n + kTurn * t)) - here) / kTurn;
    reading.by_b = reading.by_b + (slope / rho) * t;
  }
  return reading;
}

}  // namespace weft::solver
