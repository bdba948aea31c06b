// SPDX-License-Identifier: Apache-2.0
#include "material/filtering/gloss.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "material/filtering/normal_length.h"

namespace weft::material {
namespace {

constexpr double kGlossOctaves = 18;       // seed 001 eq. 2
constexpr double kBlinnPhongOctaves = 13;  // seed 004

struct ScaleName {
  GlossScale scale;
  const char* name;
};
constexpr std::array<ScaleName, 4> kScaleNames = {{{GlossScale::kAlpha, "alpha"},
                                                   {GlossScale::kRoughness, "roughness"},
                                                   {GlossScale::kGloss, "gloss"},
                                                   {GlossScale::kBlinnPhong, "blinn-phong"}}};

double by_lengths(double base, double detail) {
  return alpha_of_normal_length(normal_length(base) * normal_length(detail), std::hypot(base, detail));
}

double by_variances(double base, double detail) {
  return std::min(1.0, std::hypot(base, detail));
}

double by_printed_fit(double base, double detail) {
  const double a = on_scale(GlossScale::kGloss, base), b = on_scale(GlossScale::kGloss, detail);
  const double sum = a + b, squares = a * a + b * b, product = a * b;
  const double p = -0.535580 + 1.002204 * sum - 0.223910 * squares + 13.323150 * product;
  const double q = 1 + 8.259559 * sum + 9.896132 * squares - 22.015902 * product;
  return alpha_of(GlossScale::kGloss, p / q);
}

// Between Cauchy's lobes, whose widths add up, and Gauss's, whose squares do: GGX is the first where it is
// narrow.
double by_measure(double base, double detail) {
  const double exponent = 9.0 / 7 + 4.0 / 3 * (base * base + detail * detail);
  const double sum = std::pow(base, exponent) + std::pow(detail, exponent);
  return std::min(1.0, std::pow(sum, 1 / exponent));
}

}  // namespace

const char* name_of(GlossScale scale) {
  return std::ranges::find(kScaleNames, scale, &ScaleName::scale)->name;
}

std::optional<GlossScale> gloss_scale_named(std::string_view name) {
  const auto* found = std::ranges::find(kScaleNames, name, &ScaleName::name);
  return found == kScaleNames.end() ? std::nullopt : std::optional(found->scale);
}

AlphaRange alpha_range(GlossScale scale) {
  return {alpha_of(scale, 0) < alpha_of(scale, 1) ? alpha_of(scale, 0) : alpha_of(scale, 1),
          std::max(alpha_of(scale, 0), alpha_of(scale, 1))};
}

double blinn_phong_power(double alpha) {
  return 2 / (alpha * alpha) - 2;
}

double alpha_of_power(double power) {
  return std::sqrt(2 / (std::max(power, 0.0) + 2));
}

double on_scale(GlossScale scale, double alpha) {
  const AlphaRange range = alpha_range(scale);
  const double a = std::clamp(alpha, range.least, range.most);
  switch (scale) {
    case GlossScale::kAlpha:
      return a;
    case GlossScale::kRoughness:
      return std::sqrt(a);
    case GlossScale::kGloss:
      return std::clamp(std::log2(2 / (a * a) - 1) / kGlossOctaves, 0.0, 1.0);
    case GlossScale::kBlinnPhong:
      return std::clamp(std::log2(blinn_phong_power(a)) / kBlinnPhongOctaves, 0.0, 1.0);
  }
  return a;
}

double alpha_of(GlossScale scale, double value) {
  const double v = std::clamp(value, 0.0, 1.0);
  switch (scale) {
    case GlossScale::kAlpha:
      return v;
    case GlossScale::kRoughness:
      return v * v;
    case GlossScale::kGloss:
      return std::sqrt(2 / (1 + std::exp2(kGlossOctaves * v)));
    case GlossScale::kBlinnPhong:
      return alpha_of_power(std::exp2(kBlinnPhongOctaves * v));
  }
  return v;
}

double joined_alpha(double base, double detail, GlossJoin join) {
  const double a = std::clamp(base, 0.0, 1.0), b = std::clamp(detail, 0.0, 1.0);
  if (join == GlossJoin::kPrintedGlosses) return by_printed_fit(a, b);
  if (a == 0 || b == 0) return std::max(a, b);
  switch (join) {
    case GlossJoin::kLengths:
      return by_lengths(a, b);
    case GlossJoin::kVariances:
      return by_variances(a, b);
    default:
      return by_measure(a, b);
  }
}

}  // namespace weft::material
