// SPDX-License-Identifier: Apache-2.0
// What a blend of roughness costs against a blend of lobes, as docs/materials.md has it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

#include "core/base/vec.h"

namespace weft::material {
namespace {

// GGX's density of facets (Walter et al. 2007).
double ggx(double alpha, double cosine) {
  const double a2 = alpha * alpha, t = cosine * cosine * (a2 - 1) + 1;
  return a2 / (kPi * t * t);
}

// Integral of |mean of both lobes - lobe of the blend| over facets, each seen by its cosine. A lobe's own
// is 1.
double error_of(double a, double b, double share, double blended) {
  constexpr int kSteps = 4000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    // Steps grow from the peak outwards.
    const auto angle = [](double t) { return kPi / 2 * t * t * t; };
    const double from = angle(double(i) / kSteps), to = angle(double(i + 1) / kSteps),
                 theta = (from + to) / 2, c = std::cos(theta);
    const double mean = (1 - share) * ggx(a, c) + share * ggx(b, c);
    sum += std::abs(mean - ggx(blended, c)) * c * std::sin(theta) * 2 * kPi * (to - from);
  }
  return sum;
}

// Over pairs of roughness from 0.2 to 0.9 in tenths, at both thirds.
double mean_error(const std::function<double(double)>& there, const std::function<double(double)>& back) {
  double sum = 0;
  int count = 0;
  for (int i = 2; i <= 9; ++i) {
    for (int j = i + 1; j <= 9; ++j) {
      for (const double share : {1.0 / 3, 2.0 / 3}) {
        const double a = i / 10.0, b = j / 10.0, blended = back((1 - share) * there(a) + share * there(b));
        sum += error_of(a * a, b * b, share, blended * blended);
        ++count;
      }
    }
  }
  return sum / count;
}

TEST(RoughnessBlend, InRoughnessIsAQuarterOffAndNoOtherScaleIsMuchBetter) {
  const auto power = [](double p) { return [p](double r) { return std::pow(r, p); }; };
  const double in_roughness = mean_error(power(1), power(1));
  const double in_alpha = mean_error(power(2), power(0.5));
  const double in_alpha2 = mean_error(power(4), power(0.25));
  const double in_log =
      mean_error([](double r) { return std::log(r); }, [](double r) { return std::exp(r); });
  std::printf("L1 error of blends: roughness %.3f, alpha %.3f, alpha^2 %.3f, log %.3f\n", in_roughness,
              in_alpha, in_alpha2, in_log);
  EXPECT_NEAR(in_roughness, 0.25, 0.03);
  EXPECT_LT(in_roughness, in_alpha);
  EXPECT_LT(in_alpha, in_alpha2);
  EXPECT_GT(in_log, in_roughness - 0.02);
}

}  // namespace
}  // namespace weft::material
