// SPDX-License-Identifier: Apache-2.0
#include "material/filtering/normal_length.h"

#include <algorithm>
#include <cmath>

namespace weft::material {
namespace {

constexpr double kSeriesUpTo = 0.09;  // of a^2 = 1 - alpha^2
constexpr int kSeriesTerms = 16;      // the last is 1e-18

struct LengthAndSlope {
  double length = 1;
  double by_alpha = 0;
};

// 2/3 + 2 a^2 / 15 + 2 a^4 / 35 + ..., and its derivative by a^2.
LengthAndSlope series_of(double alpha, double a2) {
  double length = 0, by_a2 = 0;
  for (int k = kSeriesTerms; k >= 1; --k) {
    by_a2 = by_a2 * a2 + length;
    length = length * a2 + 2.0 / ((2 * k - 1) * (2 * k + 1));
  }
  return {length, -2 * alpha * by_a2};
}

LengthAndSlope length_of(double alpha) {
  const double a2 = (1 - alpha) * (1 + alpha);
  if (a2 < kSeriesUpTo) return series_of(alpha, a2);
  if (alpha <= 0) return {};
  const double a = std::sqrt(a2), atanh = std::log((1 + a) / alpha);
  const double length = (a - alpha * alpha * atanh) / (a2 * a);
  return {length, -alpha / a * (2 * atanh / a2 - 3 * length / a)};
}

}  // namespace

double normal_length(double alpha) {
  return length_of(std::clamp(alpha, 0.0, 1.0)).length;
}

double normal_length_by_area(double alpha) {
  const double kept = std::clamp(alpha, 0.0, 1.0);
  return 1 / (2 - (1 - kept) * (1 + kept) * normal_length(kept));
}

double alpha_of_normal_length(double length, double start) {
  constexpr double kRounding = 4e-16, kRoundedOne = 1 - 1e-13;
  if (!(length < kRoundedOne)) return 0;
  if (length <= 2.0 / 3) return 1;
  double low = 0, high = 1, alpha = std::clamp(start, 0.0, 1.0);
  for (int round = 0; round < 100; ++round) {
    const LengthAndSlope at = length_of(alpha);
    const double excess = at.length - length;
    if (std::abs(excess) <= kRounding) break;
    (excess > 0 ? low : high) = alpha;
    const double next = alpha - excess / at.by_alpha;
    const double before = alpha;
    alpha = next > low && next < high ? next : (low + high) / 2;
    if (alpha == before) break;
  }
  return alpha;
}

}  // namespace weft::material
