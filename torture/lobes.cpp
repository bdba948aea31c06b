// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "material/filtering/normal_length.h"
#include "material/filtering/roughness_mips.h"
#include "solver/reflectance/lobe.h"
#include "torture/hard_case.h"

namespace weft::torture {
namespace {

std::optional<double> percent_off(double is, long double should) {
  if (!std::isfinite(is)) return std::nullopt;
  return static_cast<double>(100 * std::abs(is / should - 1));
}

/// Smith's masking by the cosine of a direction, over that cosine.
template <typename Scalar>
Scalar smith_over_cosine(Scalar alpha, Scalar cosine) {
  return 2 / (cosine + std::sqrt(alpha * alpha + (1 - alpha * alpha) * cosine * cosine));
}

HardCase touching_light() {
  constexpr double kAlpha = 0.3, kF0 = 0.04;
  const Vec3 n = {0, 0, 1}, light = {1, 0, 0}, view = {0, 0, 1}, half = normalized(light + view);
  const double a2 = kAlpha * kAlpha;
  const auto facets = [&](auto cosine) {
    const auto spread = cosine * cosine * (a2 - 1) + 1;
    return a2 / (kPi * spread * spread);
  };
  const double fresnel = kF0 + (1 - kF0) * std::pow(1 - dot(light, half), 5);
  const double nl = dot(n, light), nv = dot(n, view);
  const double masking = smith_over_cosine(kAlpha, nl) * nl * smith_over_cosine(kAlpha, nv) * nv;
  const double plain = kPi * fresnel * facets(dot(n, half)) * masking / (4 * nl * nv);
  const long double truth = static_cast<long double>(kPi * fresnel) * facets(std::sqrt(0.5L)) *
                            smith_over_cosine<long double>(kAlpha, 0) *
                            smith_over_cosine<long double>(kAlpha, 1) / 4;
  const solver::Lobe lobe = {.family = solver::LobeFamily::kGgx, .alpha = kAlpha, .f0 = kF0};
  return {.stage = "gloss",
          .what = "a highlight of a light that just touches the cloth",
          .unit = "%",
          .plain = percent_off(plain, truth),
          .ours = percent_off(solver::specular(lobe, n, {light, view}, 0), truth),
          .within = 0.01};
}

/// 2/3 + 2 a^2 / 15 + 2 a^4 / 35 + ..., a^2 being 1 - alpha^2.
long double length_by_series(long double alpha) {
  const long double a2 = 1 - alpha * alpha;
  long double sum = 0, power = 1;
  for (int k = 1; k < 40; ++k) {
    sum += power * 2 / ((2 * k - 1) * (2 * k + 1));
    power *= a2;
  }
  return sum;
}

HardCase roughest_cloth() {
  constexpr float kAlpha = 0.99999F;
  const float a = std::sqrt(1 - kAlpha * kAlpha);
  const float plain = (a - (1 - a * a) * std::atanh(a)) / (a * a * a);
  const long double truth = length_by_series(kAlpha);
  return {.stage = "gloss",
          .what = "the mean facet of cloth as rough as can be",
          .unit = "% of its length",
          .plain = percent_off(double{plain}, truth),
          .ours = percent_off(material::normal_length(double{kAlpha}), truth),
          .within = 1e-10};
}

HardCase too_long_a_mean() {
  constexpr double kLength = 1 + 1e-7;  // float32 normals that are all alike
  const double kappa = (3 * kLength - kLength * kLength * kLength) / (1 - kLength * kLength);
  const double plain = std::sqrt(2 / kappa), ours = std::sqrt(2 * material::inverse_kappa(kLength));
  return {.stage = "gloss",
          .what = "a mean normal that rounding made longer than 1",
          .unit = "of alpha",
          .plain = std::isfinite(plain) ? std::optional(plain) : std::nullopt,
          .ours = ours,
          .within = 0};
}

HardCase cancelled_normals() {
  const Vec3 first = {1, 0, 0}, second = {-1, 0, 0};
  const Vec3 plain = normalized(first + second);
  material::Footprint both;
  both.add(1, first, {0.2, 0.2, 0});
  both.add(1, second, {0.2, 0.2, 0});
  const material::MipTexel texel = material::filtered(both, material::MipRule::kVmf);
  const double plain_deg = angle_deg(plain, {0, 0, 1});
  return {.stage = "gloss",
          .what = "a texel over normals that cancel",
          .unit = "degrees",
          .plain = std::isfinite(plain_deg) ? std::optional(plain_deg) : std::nullopt,
          .ours = angle_deg(texel.normal, {0, 0, 1}),
          .flag = texel.lobe.across == 1 ? "as rough as can be" : "",
          .within = 0,
          .must_say = "as rough as can be"};
}

}  // namespace

std::vector<HardCase> hard_lobes() {
  return {touching_light(), roughest_cloth(), too_long_a_mean(), cancelled_normals()};
}

}  // namespace weft::torture
