// SPDX-License-Identifier: Apache-2.0
#include "material/filtering/joined_gloss.h"

#include <algorithm>
#include <cmath>

#include "material/filtering/normal_length.h"

namespace weft::material {
namespace {

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
