// SPDX-License-Identifier: Apache-2.0
#include "material/filtering/joined_gloss.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/vec.h"
#include "material/filtering/normal_length.h"

namespace weft::material {
namespace {

constexpr GlossScale kScales[] = {GlossScale::kAlpha, GlossScale::kRoughness, GlossScale::kGloss,
                                  GlossScale::kBlinnPhong};

TEST(GlossScale, HasTheValuesOfItsFormulas) {
  EXPECT_DOUBLE_EQ(alpha_of(GlossScale::kRoughness, 0.5), 0.25);
  EXPECT_DOUBLE_EQ(alpha_of(GlossScale::kGloss, 0), 1) << "seed 001 eq. 2 reaches 1, its eq. 1 does not";
  EXPECT_NEAR(alpha_of(GlossScale::kGloss, 0.5), std::sqrt(2.0 / 513), 1e-15);
  EXPECT_NEAR(alpha_of(GlossScale::kGloss, 1), 0.002762, 1e-6);
  EXPECT_NEAR(blinn_phong_power(alpha_of(GlossScale::kBlinnPhong, 1)), 8192, 1e-6);
  EXPECT_NEAR(alpha_of(GlossScale::kBlinnPhong, 0), std::sqrt(2.0 / 3), 1e-15);
}

TEST(GlossScale, LeadsBackToAlphaInItsRangeAndToItsEndsBeyond) {
  for (const GlossScale scale : kScales) {
    const AlphaRange range = alpha_range(scale);
    for (int i = 0; i <= 100; ++i) {
      const double alpha = range.least + (range.most - range.least) * i / 100;
      EXPECT_NEAR(alpha_of(scale, on_scale(scale, alpha)), alpha, 1e-12) << name_of(scale);
    }
    for (const double alpha : {-1.0, 0.0, 1.0, 7.0}) {
      const double value = on_scale(scale, alpha);
      EXPECT_TRUE(value >= 0 && value <= 1) << name_of(scale) << ' ' << alpha << ' ' << value;
    }
    EXPECT_EQ(gloss_scale_named(name_of(scale)), scale);
  }
  EXPECT_FALSE(gloss_scale_named("shininess"));
}

TEST(GlossScale, ABlinnPhongLobeFallsOffAsBeckmannsOfItsAlphaDoes) {
  for (const double power : {8.0, 100.0, 5000.0}) {
    const double alpha2 = std::pow(alpha_of_power(power), 2), angle = 1e-3 / std::sqrt(power);
    const double c = std::cos(angle), tan2 = (1 - c * c) / (c * c);
    const double beckmann = std::exp(-tan2 / alpha2) / std::pow(c, 4),
                 ggx = std::pow(1 + tan2 / alpha2, -2) / std::pow(c, 4);
    EXPECT_NEAR((1 - beckmann) / (1 - std::pow(c, power)), 1 - 2 / power, 1e-3) << power;
    EXPECT_NEAR((1 - ggx) / (1 - std::pow(c, power)), 2, 1e-3) << power << ": GGX is sharper at its peak";
  }
}

// The product of eq. 35-37 as the glosses that eq. 34 has.
double exact_gloss(double a, double b) {
  const double length =
      normal_length(alpha_of(GlossScale::kGloss, a)) * normal_length(alpha_of(GlossScale::kGloss, b));
  return on_scale(GlossScale::kGloss, alpha_of_normal_length(length));
}

TEST(GlossJoin, ThePrintedFitIsThisFarFromTheProductOfLengths) {
  double worst = 0, squares = 0;
  int count = 0;
  for (int i = 0; i <= 32; ++i) {
    for (int j = 0; j <= 32; ++j) {
      const double a = i / 32.0, b = j / 32.0;
      const double joined = joined_alpha(alpha_of(GlossScale::kGloss, a), alpha_of(GlossScale::kGloss, b),
                                         GlossJoin::kPrintedGlosses);
      const double off = on_scale(GlossScale::kGloss, joined) - exact_gloss(a, b);
      worst = std::max(worst, std::abs(off));
      squares += off * off;
      ++count;
    }
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_NEAR(worst, 0.0167, 0.0005);
  EXPECT_NEAR(std::sqrt(squares / count), 0.0050, 0.0005);
}

TEST(GlossJoin, OfNothingIsTheOtherAndNoneIsRougherThanOne) {
  for (const GlossJoin join : {GlossJoin::kMeasured, GlossJoin::kLengths, GlossJoin::kVariances}) {
    for (const double alpha : {0.0, 0.05, 0.35, 1.0}) {
      EXPECT_EQ(joined_alpha(alpha, 0, join), alpha);
      EXPECT_EQ(joined_alpha(0, alpha, join), alpha);
      EXPECT_LE(joined_alpha(alpha, 1, join), 1);
      EXPECT_GE(joined_alpha(alpha, 0.2, join), std::max(alpha, 0.2));
      EXPECT_NEAR(joined_alpha(alpha, 0.2, join), joined_alpha(0.2, alpha, join), 1e-9);
    }
  }
}

TEST(GlossJoin, IsTheLobeThatFacetsOnFacetsHave) {
  // Best single GGX of 3000 sampled facets, as `weft bench maps --part gloss` searches it.
  struct Join {
    double base, detail, best;
  };
  for (const Join& j : {Join{0.05, 0.05, 0.0857}, Join{0.1, 0.2, 0.2597}, Join{0.1, 0.5, 0.5298},
                        Join{0.3, 0.3, 0.4799}, Join{0.3, 0.5, 0.6208}, Join{0.5, 0.5, 0.7131}}) {
    EXPECT_NEAR(joined_alpha(j.base, j.detail) / j.best, 1, 0.025) << j.base << ' ' << j.detail;
  }
  EXPECT_NEAR(joined_alpha(0.1, 0.1, GlossJoin::kLengths), 0.158, 0.001);
  EXPECT_NEAR(joined_alpha(0.5, 0.5, GlossJoin::kLengths), 0.940, 0.001)
      << "lengths of broad lobes say too much";
  EXPECT_NEAR(joined_alpha(0.3, 0.3, GlossJoin::kVariances), 0.424, 0.001)
      << "and variances of narrow ones too little";
}

// Seed 004, figures 15 and 16: E, its fit, and (2 m + 1) / 8, by gloss.
double norm_and_visibility(double gloss) {
  const double m = std::exp2(13 * gloss), a = 1 / std::sqrt(kPi / 4 * m + kPi / 2),
               mean = -std::log(a) / (1 - a);
  return (m + 2) / 8 * mean * mean;
}

TEST(BlinnPhongNorm, AndItsAverageVisibilityAreMissedByTheFitByAFactorOfTwo) {
  double least = 1e9, most = 0, of_chosen = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double gloss = i / 1000.0,
                 ratio = std::exp2(-1.85689 + 16.1624 * gloss) / norm_and_visibility(gloss);
    least = std::min(least, ratio);
    most = std::max(most, ratio);
    of_chosen = std::max(of_chosen, (2 * std::exp2(13 * gloss) + 1) / 8 / norm_and_visibility(gloss));
  }
  EXPECT_NEAR(least, 0.487, 0.001);
  EXPECT_NEAR(most, 1.184, 0.001);
  EXPECT_NEAR(norm_and_visibility(0), 0.567, 0.0005) << "3 / 8 is the norm alone";
  EXPECT_LT(of_chosen, 0.74) << "that one is never above";
}

}  // namespace
}  // namespace weft::material
