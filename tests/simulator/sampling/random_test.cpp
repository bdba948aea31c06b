// SPDX-License-Identifier: Apache-2.0
#include "simulator/sampling/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace weft::simulator {
namespace {

constexpr std::uint32_t kDraws = 100000;

using Block = std::array<std::uint32_t, 4>;

Block block(std::uint32_t i, std::uint32_t stream = 0) {
  return philox({i, stream, 0, 0}, {20260131, 5});
}

double poisson_probability(double mean, double count) {
  return std::exp(count * std::log(mean) - mean - std::lgamma(count + 1));
}

// Vectors of the file kat_vectors of the authors' library Random123.
TEST(Philox, GivesTheAuthorsKnownAnswers) {
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Uniform, StaysInsideTheOpenInterval) {
  EXPECT_GT(uniform(0, 0), 0);
  EXPECT_LT(uniform(0xffffffff, 0xffffffff), 1);
  EXPECT_NEAR(uniform(0x80000000, 0), 0.5, 1e-15);
}

TEST(NormalPair, FillsTwentyEqualBinsOfTheNormalDistributionAlike) {
  constexpr int kBins = 20;
  std::array<std::array<double, kBins>, 2> seen = {};
  double product = 0;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const NormalPair pair = normal_pair(block(i));
    const double values[2] = {pair.first, pair.second};
    for (std::size_t k = 0; k < 2; ++k) {
      const double u = std::erfc(-values[k] / std::sqrt(2.0)) / 2;
      ++seen[k][static_cast<std::size_t>(std::min(u * kBins, kBins - 1.0))];
    }
    product += pair.first * pair.second;
  }
  for (const auto& bins : seen) {
    double chi2 = 0;
    for (const double n : bins) chi2 += (n - kDraws / kBins) * (n - kDraws / kBins) / (kDraws / kBins);
    EXPECT_LT(chi2, 43.8) << "passed by 999 of 1000 seeds with 19 degrees of freedom";
  }
  EXPECT_LT(std::abs(product) / std::sqrt(double{kDraws}), 4) << "the two are independent";
}

TEST(Poisson, HasItsMeanAndVariance) {
  std::uint32_t stream = 1;
  for (const double mean : {0.05, 1.0, 9.5, 63.9, 64.0, 400.0, 36000.0}) {
    double sum = 0, sum_of_squares = 0;
    for (std::uint32_t i = 0; i < kDraws; ++i) {
      const double d = poisson(mean, normal_pair(block(i, stream)).first) - mean;
      sum += d;
      sum_of_squares += d * d;
    }
    ++stream;
    const double mean_error = sum / kDraws / std::sqrt(mean / kDraws);
    const double variance_error =
        (sum_of_squares / kDraws - mean) / std::sqrt((mean + 2 * mean * mean) / kDraws);
    EXPECT_LT(std::abs(mean_error), 4) << "standard errors at mean " << mean;
    EXPECT_LT(std::abs(variance_error), 4) << "standard errors at mean " << mean;
  }
}

TEST(Poisson, HasItsDistributionOnBothSidesOfTheExpansion) {
  std::uint32_t stream = 50;
  for (const double mean : {2.0, 20.0, 63.9, 64.0, 130.0}) {
    std::vector<double> seen(1000);
    for (std::uint32_t i = 0; i < kDraws; ++i) {
      ++seen.at(static_cast<std::size_t>(poisson(mean, normal_pair(block(i, stream)).first)));
    }
    ++stream;
    double chi2 = 0;
    int bins = 0;
    for (std::size_t n = 0; n < seen.size(); ++n) {
      const double expected = kDraws * poisson_probability(mean, static_cast<double>(n));
      if (expected < 10) continue;
      chi2 += (seen[n] - expected) * (seen[n] - expected) / expected;
      ++bins;
    }
    EXPECT_GT(bins, 5);
    // Mean and standard deviation of chi-square with that many degrees of freedom.
    EXPECT_LT(chi2, bins + 4 * std::sqrt(2.0 * bins)) << "mean " << mean;
  }
}

TEST(Poisson, StaysInItsStatedDistanceFromTheDistribution) {
  for (const double mean : {64.0, 100.0, 1000.0}) {
    double distance = 0, probability_below = 0;
    for (double count = std::floor(mean - 8 * std::sqrt(mean)); count < mean + 8 * std::sqrt(mean); ++count) {
      double low = -8.6, high = 8.6;  // the quantile at which the variate exceeds `count`
      for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (poisson(mean, middle) > count ? high : low) = middle;
      }
      const double probability_up_to = std::erfc(-high / std::sqrt(2.0)) / 2;
      distance += std::abs(probability_up_to - probability_below - poisson_probability(mean, count)) / 2;
      probability_below = probability_up_to;
    }
    EXPECT_LT(distance, 3.2e-5) << "total variation at mean " << mean;
  }
}

TEST(Poisson, GivesWholeCountsFromZeroUpWhateverTheQuantile) {
  for (const double mean : {1e-9, 0.7, 30.0, 63.99, 64.0, 65.0, 1e5, 1e12}) {
    double last = -1;
    for (double w = -8.6; w <= 8.6; w += 0.01) {
      const double count = poisson(mean, w);
      ASSERT_EQ(count, std::floor(count));
      ASSERT_GE(count, 0);
      ASSERT_GE(count, last) << "mean " << mean << ", quantile " << w;
      ASSERT_LT(count, mean + 9 * std::sqrt(mean) + 40);
      last = count;
    }
  }
  EXPECT_EQ(poisson(0, 3), 0);
  EXPECT_EQ(poisson(-1, 3), 0);
}

}  // namespace
}  // namespace weft::simulator
