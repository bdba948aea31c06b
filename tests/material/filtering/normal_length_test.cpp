// SPDX-License-Identifier: Apache-2.0
#include "material/filtering/normal_length.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/vec.h"
#include "material/filtering/joined_gloss.h"
#include "tests/material/filtering/listing8.h"

namespace weft::material {
namespace {

// Integral over the hemisphere of GGX facets (seed 000 eq. 2) times cos^power, by the midpoint rule in the
// share of facets that lie closer to the normal, u = tan^2 / (alpha^2 + tan^2).
double facets(double alpha, double power) {
  constexpr int kSteps = 400000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double u = (i + 0.5) / kSteps;
    const double cosine = std::sqrt((1 - u) / (1 + (alpha * alpha - 1) * u));
    sum += std::pow(cosine, power - 1);
  }
  return sum / kSteps;
}

double halton(int i, int base) {
  double value = 0, share = 1;
  for (; i > 0; i /= base) {
    share /= base;
    value += share * (i % base);
  }
  return value;
}

double listing7(float alpha) {
  const float a = std::sqrt(1.0F - alpha * alpha);
  return double{(a - (1 - a * a) * std::atanh(a)) / (a * a * a)};
}

double gloss_length(double gloss) {
  return normal_length(alpha_of(GlossScale::kGloss, gloss));
}

TEST(NormalLength, IsEveryEntryOfListing8ToItsSampling) {
  double worst = 0, sum = 0;
  for (std::size_t i = 0; i < kListing8.size(); ++i) {
    const double off = kListing8[i] - gloss_length(static_cast<double>(i) / 255);
    worst = std::max(worst, std::abs(off));
    sum += off;
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 3.5e-6);
  EXPECT_NEAR(sum / 256, 2.0e-6, 0.2e-6) << "all entries are high by their sampling";
}

TEST(NormalLength, IsTheIntegralOfTheFacetsByTheAreaTheyCover) {
  for (const double alpha : {0.01, 0.1, 0.3, 0.6, 0.9, 0.96, 0.99, 1.0}) {
    EXPECT_NEAR(normal_length(alpha), facets(alpha, 2), 2e-6) << alpha;
  }
}

TEST(NormalLength, ByTheFacetsOwnAreaIsOneOverTheirArea) {
  // Seed 001 eq. 19-22: dividing the weight by the cosine leads from one mean to the other.
  for (const double alpha : {0.3, 0.6, 0.9, 0.99, 1.0}) {
    EXPECT_NEAR(normal_length_by_area(alpha), 1 / facets(alpha, 0), 2e-3) << alpha;
  }
  EXPECT_DOUBLE_EQ(normal_length_by_area(1), 0.5);
  EXPECT_DOUBLE_EQ(normal_length_by_area(0), 1);
}

TEST(NormalLength, DiffersBetweenBothAreasByUpToASixth) {
  double most = 0;
  for (int i = 0; i <= 1000; ++i) {
    most = std::max(most, normal_length(i / 1000.0) - normal_length_by_area(i / 1000.0));
  }
  EXPECT_NEAR(most, 0.167, 0.0005);
}

TEST(NormalLength, IsWhatSamplingOfListing6Finds) {
  constexpr int kSamples = 100000;
  for (const double alpha : {0.1, 0.5, 1.0}) {
    Vec3 sum;
    for (int i = 1; i <= kSamples; ++i) {
      const double y = halton(i, 3), cosine = std::sqrt((1 - y) / (1 + (alpha * alpha - 1) * y));
      const double sine = std::sqrt(1 - cosine * cosine), phi = 2 * kPi * halton(i, 2);
      sum = sum + Vec3{sine * std::cos(phi), sine * std::sin(phi), cosine};
    }
    EXPECT_NEAR(length(sum) / kSamples, normal_length(alpha), 5e-5) << alpha;
  }
}

TEST(NormalLength, KeepsItsDigitsWhereListing7LosesThem) {
  const double alpha = 0.99999;
  EXPECT_GT(std::abs(listing7(static_cast<float>(alpha)) - normal_length(double{static_cast<float>(alpha)})),
            1e-3);
  EXPECT_NEAR(normal_length(alpha), 2.0 / 3 + 2.0 / 15 * (1 - alpha * alpha), 1e-9);
  const double seam = std::sqrt(1 - 0.09);
  EXPECT_NEAR(normal_length(seam - 1e-12), normal_length(seam + 1e-12), 1e-11) << "where its two forms meet";
}

TEST(NormalLength, LeadsBackToItsAlpha) {
  double worst = 0;
  for (int i = 0; i <= 2000; ++i) {
    const double alpha = i / 2000.0;
    worst = std::max(worst, std::abs(alpha_of_normal_length(normal_length(alpha)) - alpha));
  }
  EXPECT_LT(worst, 1e-9);
  EXPECT_EQ(alpha_of_normal_length(1.5), 0);
  EXPECT_EQ(alpha_of_normal_length(0.2), 1);
  EXPECT_EQ(alpha_of_normal_length(std::nan("")), 0);
  EXPECT_EQ(alpha_of_normal_length(normal_length(0.37), 0.37), 0.37) << "a right start stays";
}

TEST(RationalFits, OfSeed001AreOffAsThisAndOneCannotBeTurnedBack) {
  const auto fit40 = [](double x) {
    return (0.66693 + 0.0609009 * x + 7.32398 * x * x + 0.600464 * x * x * x) /
           (1 - 1.13467 * x + 8.78264 * x * x);
  };
  const auto fit42 = [](double x) {
    return (0.66667 + 0.0942205 * x + 7.41935 * x * x + 0.567111 * x * x * x) /
           (1 - 1.0881 * x + 8.83582 * x * x);
  };
  EXPECT_NEAR(fit40(1), 1.0005, 5e-5) << "a length over 1";
  double worst = 0;
  for (int i = 0; i <= 255; ++i)
    worst = std::max(worst, std::abs(fit42(i / 255.0) - gloss_length(i / 255.0)));
  EXPECT_NEAR(worst, 3.2e-4, 0.1e-4);
  const auto read_back = [&](double gloss) {
    return on_scale(GlossScale::kGloss, alpha_of_normal_length(fit42(gloss)));
  };
  EXPECT_NEAR(read_back(0.784), 0.753, 0.001);
  EXPECT_NEAR(read_back(0.863), 0.777, 0.001);
  EXPECT_NEAR(read_back(0.941), 0.821, 0.001) << "a length of the fit is another gloss";
}

}  // namespace
}  // namespace weft::material
