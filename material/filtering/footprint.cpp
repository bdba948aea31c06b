// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "material/filtering/normal_length.h"
#include "material/filtering/roughness_mips.h"

namespace weft::material {
namespace {

// What is left of 1 - r^2 where all normals are the same.
constexpr double kRoundedSpread = 1e-13;
constexpr double kLeastHeightOfNormal = 0.05;  // slopes of 20
constexpr double kNoDirection = 1e-9;

/// A symmetric tensor of x and y.
struct Tensor {
  double xx = 0, xy = 0, yy = 0;

  double trace() const { return xx + yy; }
  friend Tensor operator*(double s, Tensor t) { return {s * t.xx, s * t.xy, s * t.yy}; }
  friend Tensor operator+(Tensor a, Tensor b) { return {a.xx + b.xx, a.xy + b.xy, a.yy + b.yy}; }
};

constexpr Tensor kUnit = {1, 0, 1};

/// Its axes: squares of both alphas, and the azimuth of the narrow one.
struct Axes {
  double wide = 1, narrow = 1;
  double azimuth_deg = 0;
};

Axes axes_of(Tensor t) {
  const double middle = t.trace() / 2, half = (t.xx - t.yy) / 2, spread = std::hypot(half, t.xy);
  if (!(spread > 1e-12 * middle)) return {middle, middle, 0};
  const double azimuth_deg = degrees(std::atan2(t.xy, half)) / 2 + 90;
  return {middle + spread, std::max(middle - spread, 0.0),
          azimuth_deg >= 180 ? azimuth_deg - 180 : azimuth_deg};
}

LobeWidth width_of(const Axes& axes) {
  return {std::sqrt(std::clamp(axes.wide, 0.0, 1.0)), std::sqrt(std::clamp(axes.narrow, 0.0, 1.0)),
          axes.azimuth_deg};
}

// What one axis cannot take, since no alpha is over 1, the other takes.
Axes shared_out(Axes axes) {
  const double surplus = std::max(axes.wide - 1, 0.0);
  return {axes.wide - surplus, axes.narrow + surplus, axes.azimuth_deg};
}

// Blinn-Phong's 1 / m grows by (1 - r) / r; it is alpha^2 / (2 - 2 alpha^2).
double toksvig(double alpha2, double r) {
  if (alpha2 >= 1) return 1;
  const double inverse_power = alpha2 / (2 - 2 * alpha2) + std::max(1 - r - kRoundedSpread, 0.0) / r;
  return 2 * inverse_power / (1 + 2 * inverse_power);
}

// Covariance of the unit normals' parts across their mean, in its tangents: t above x, b = n x t.
Tensor covariance_across(const Footprint& f, Vec3 n) {
  const auto& [xx, xy, yy, xz, yz] = f.products;
  const double zz = f.weight - xx - yy;
  const Mat3 products = {{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}}};
  const Vec3 t = normalized({n.z, 0, -n.x}), b = cross(n, t);
  return (1 / f.weight) * Tensor{dot(t, products * t), dot(t, products * b), dot(b, products * b)};
}

Tensor covariance_of_slopes(const Footprint& f) {
  const double w = f.weight, p = f.slopes[0] / w, q = f.slopes[1] / w;
  const auto above_rounding = [](double square, double mean) {
    return std::max(square - mean * mean - kRoundedSpread * square, 0.0);
  };
  const double pp = above_rounding(f.slopes[2] / w, p), qq = above_rounding(f.slopes[4] / w, q);
  return {pp, pp > 0 && qq > 0 ? f.slopes[3] / w - p * q : 0, qq};
}

Axes along_yarns(const Footprint& f, Vec3 n, Tensor alpha2, double spread) {
  const Tensor across = covariance_across(f, n);
  if (!(spread > 0 && across.trace() > 0)) return axes_of(alpha2);
  return shared_out(axes_of(alpha2 + (2 * spread / across.trace()) * across));
}

Axes by_lengths(const Footprint& f, Tensor alpha2) {
  const double mean2 = alpha2.trace() / 2;
  const double alpha =
      alpha_of_normal_length(length(f.shortened) / f.weight, std::sqrt(std::min(mean2, 1.0)));
  if (!(mean2 > 0)) return {alpha * alpha, alpha * alpha, 0};
  return shared_out(axes_of((alpha * alpha / mean2) * alpha2));
}

Axes by_toksvig(Tensor alpha2, double r) {
  const Axes axes = axes_of(alpha2);
  return {toksvig(axes.wide, r), toksvig(axes.narrow, r), axes.azimuth_deg};
}

Axes axes_by(MipRule rule, const Footprint& f, Vec3 n, double r) {
  const Tensor alpha2 = (1 / f.weight) * Tensor{f.alphas[0], f.alphas[1], f.alphas[2]};
  const double spread = inverse_kappa(r);
  switch (rule) {
    case MipRule::kVmf:
      return axes_of(alpha2 + 2 * spread * kUnit);
    case MipRule::kVmfYarns:
      return along_yarns(f, n, alpha2, 2 * spread);
    case MipRule::kVmfSeedCode:
      return axes_of(alpha2 + spread * kUnit);
    case MipRule::kVmfSeedEq37:
      return axes_of(alpha2 + 0.5 * spread * kUnit);
    case MipRule::kToksvig:
      return by_toksvig(alpha2, r);
    case MipRule::kLengths:
      return by_lengths(f, alpha2);
    case MipRule::kLean:
      return axes_of(alpha2 + 2 * covariance_of_slopes(f));
    case MipRule::kClean:
      return axes_of(alpha2 + covariance_of_slopes(f).trace() * kUnit);
    case MipRule::kNone:
      break;
  }
  return axes_of(alpha2);
}

}  // namespace

const char* name_of(MipRule rule) {
  return std::ranges::find(kMipRules, rule, &MipRuleName::rule)->name;
}

std::optional<MipRule> mip_rule_named(std::string_view name) {
  const auto* found = std::ranges::find(kMipRules, name, &MipRuleName::name);
  return found == kMipRules.end() ? std::nullopt : std::optional(found->rule);
}

double inverse_kappa(double r) {
  return std::max((1 - r) * (1 + r) - kRoundedSpread, 0.0) / (r * (3 - r * r));
}

void Footprint::add(double w, Vec3 n, const LobeWidth& lobe, double shortening) {
  const double z = std::max(n.z, kLeastHeightOfNormal), p = -n.x / z, q = -n.y / z;
  const double c = std::cos(radians(lobe.azimuth_deg)), s = std::sin(radians(lobe.azimuth_deg));
  const double along2 = lobe.along * lobe.along, more = lobe.across * lobe.across - along2;
  weight += w;
  normal = normal + w * n;
  shortened = shortened + w * shortening * n;
  const std::array<double, 5> product = {n.x * n.x, n.x * n.y, n.y * n.y, n.x * n.z, n.y * n.z};
  const std::array<double, 5> slope = {p, q, p * p, p * q, q * q};
  const std::array<double, 3> alpha2 = {along2 + more * s * s, -more * s * c, along2 + more * c * c};
  for (std::size_t i = 0; i < product.size(); ++i) products[i] += w * product[i];
  for (std::size_t i = 0; i < slope.size(); ++i) slopes[i] += w * slope[i];
  for (std::size_t i = 0; i < alpha2.size(); ++i) alphas[i] += w * alpha2[i];
}

void Footprint::add(double share, const Footprint& other) {
  weight += share * other.weight;
  normal = normal + share * other.normal;
  shortened = shortened + share * other.shortened;
  for (std::size_t i = 0; i < products.size(); ++i) products[i] += share * other.products[i];
  for (std::size_t i = 0; i < slopes.size(); ++i) slopes[i] += share * other.slopes[i];
  for (std::size_t i = 0; i < alphas.size(); ++i) alphas[i] += share * other.alphas[i];
}

MipTexel filtered(const Footprint& f, MipRule rule) {
  if (!(f.weight > 0)) return {};
  const Vec3 sum = rule == MipRule::kLengths ? f.shortened : f.normal;
  const double size = length(sum), r = length(f.normal) / f.weight;
  if (!(size > kNoDirection * f.weight)) return {};
  const bool by_slopes = rule == MipRule::kLean || rule == MipRule::kClean;
  const Vec3 mean = by_slopes ? Vec3{-f.slopes[0], -f.slopes[1], f.weight} : sum;
  const Vec3 normal = normalized(mean);
  return {normal, width_of(axes_by(rule, f, normal, r))};
}

}  // namespace weft::material
