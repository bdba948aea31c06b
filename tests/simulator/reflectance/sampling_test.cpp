// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/simulator/reflectance/measured.h"

namespace weft::simulator {
namespace {

constexpr int kRows = 12, kColumns = 16;  // bins of z from -1 to 1 and of azimuth
constexpr std::size_t kBins = std::size_t{kRows} * kColumns;

std::size_t bin(int row, int column) {
  return static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column);
}

std::size_t bin_of(Vec3 d) {
  const double turn = std::atan2(d.y, d.x) / (2 * kPi);
  const int row = std::clamp(static_cast<int>((d.z + 1) / 2 * kRows), 0, kRows - 1);
  const int column = std::clamp(static_cast<int>((turn < 0 ? turn + 1 : turn) * kColumns), 0, kColumns - 1);
  return bin(row, column);
}

/// The probability of each bin: the density integrated over it.
std::vector<double> probabilities(const Reflectance& model, Vec3 view) {
  constexpr int kSteps = 16;
  constexpr double kArea = 4 * kPi / (kRows * kColumns * kSteps * kSteps);
  std::vector<double> bins(kBins, 0.0);
  for (int j = 0; j < kRows * kSteps; ++j) {
    for (int i = 0; i < kColumns * kSteps; ++i) {
      const Vec3 d = from_cosine(2 * (j + 0.5) / (kRows * kSteps) - 1, (i + 0.5) / (kColumns * kSteps));
      bins[bin(j / kSteps, i / kSteps)] += density(model, d, view) * kArea;
    }
  }
  return bins;
}

/// How many standard deviations too large the chi-square of samples against their probabilities is (Wilson
/// and Hilferty 1931); bins are joined until each expects eight.
double excess(const std::vector<double>& expected, const std::vector<double>& counted) {
  double chi_square = 0, e = 0, n = 0;
  int bins = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    e += expected[i];
    n += counted[i];
    if (e < 8) continue;
    chi_square += (n - e) * (n - e) / e;
    ++bins;
    e = n = 0;
  }
  const double k = bins - 1;
  return (std::cbrt(chi_square / k) - (1 - 2 / (9 * k))) / std::sqrt(2 / (9 * k));
}

const std::vector<NamedModel> kSampled = {
    {"Lambert", Lambert()},
    {"GGX 0.3", Ggx{0.3}},
    {"GGX 1", Ggx{1}},
    {"anisotropic GGX", AnisotropicGgx{0.6, 0.6}},
    {"Beckmann 0.4", Beckmann{0.4}},
    {"Blinn-Phong 0.3", BlinnPhong{0.3}},
    {"cloth 0.2", Cloth{0.2}},
    {"cloth 0.8", Cloth{0.8}},
    {"multiple scattering", MultipleScattering{0.3}},
};
const std::vector<Vec3> kViews = {at_angles(0), at_angles(50, 30), at_angles(75, 200), at_angles(110, 70)};

TEST(Sampling, DensityIntegratesToOneOverTheSphere) {
  for (const NamedModel& each : kSampled) {
    for (const Vec3& view : kViews) {
      double sum = 0;
      for (const double p : probabilities(each.model, view)) sum += p;
      EXPECT_NEAR(sum, 1, 0.01) << each.name << " from z " << view.z;
    }
  }
}

TEST(Sampling, DirectionsFallAsTheDensitySays) {
  constexpr int kSamples = 20000;
  for (const NamedModel& each : kSampled) {
    for (const Vec3& view : kViews) {
      Uniform uniform_number(7);
      std::vector<double> counted(kBins, 0.0);
      for (int i = 0; i < kSamples; ++i) {
        const double u1 = uniform_number();
        counted[bin_of(sample(each.model, view, u1, uniform_number()).to_light)] += 1;
      }
      std::vector<double> expected = probabilities(each.model, view);
      for (double& e : expected) e *= kSamples;
      EXPECT_LT(excess(expected, counted), 4) << each.name << " from z " << view.z;
    }
  }
}

TEST(Sampling, ChiSquareTellsAWrongDensity) {
  const std::vector<double> expected(100, 200.0);
  std::vector<double> counted(100, 200.0);
  for (std::size_t i = 0; i < 100; ++i) counted[i] += i % 2 == 0 ? 14 : -14;  // one standard deviation each
  EXPECT_NEAR(excess(expected, counted), 0, 1);
  for (std::size_t i = 0; i < 100; ++i) counted[i] = 200 + (i % 2 == 0 ? 28 : -28);
  EXPECT_GT(excess(expected, counted), 10);
}

TEST(Sampling, GivesUnitDirectionsWithTheDensityOfTheirDirectionAtEveryLimit) {
  for (const NamedModel& each : models()) {
    for (const Vec3& view :
         {Vec3{0, 0, 1}, Vec3{1, 0, 0}, at_angles(60, 200), at_angles(120, 10), Vec3{0, 0, -1}}) {
      for (const double u1 : {0.0, 0.49999, 0.5, 0.75, 1 - 1e-16}) {
        for (const double u2 : {0.0, 0.3, 1 - 1e-16}) {
          const DirectionSample s = sample(each.model, view, u1, u2);
          EXPECT_NEAR(length(s.to_light), 1, 1e-9) << each.name << " " << u1 << " " << u2;
          EXPECT_TRUE(std::isfinite(s.density) && s.density >= 0) << each.name << " gives " << s.density;
          EXPECT_EQ(s.density, density(each.model, s.to_light, view)) << each.name;
        }
      }
    }
  }
}

}  // namespace
}  // namespace weft::simulator
