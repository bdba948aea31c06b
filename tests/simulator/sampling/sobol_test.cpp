// SPDX-License-Identifier: Apache-2.0
#include "simulator/sampling/sobol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "simulator/sampling/random.h"

namespace weft::simulator {
namespace {

constexpr std::uint64_t kSeed = 20260131;

// Sobol's own definition: the second dimension's direction numbers are v_k = v_(k-1) xor v_(k-1) / 2.
TEST(Sobol, IsSobolsSequenceBeforeItIsScrambled) {
  for (std::uint32_t i = 0; i < 5000; ++i) {
    std::uint32_t first = 0, second = 0, v = 1u << 31;
    for (std::uint32_t bit = 0; bit < 32; ++bit, v ^= v >> 1) {
      if ((i >> bit & 1) == 0) continue;
      first |= 1u << (31 - bit);
      second ^= v;
    }
    ASSERT_EQ(detail::reversed_bits(i), first) << i;
    ASSERT_EQ(detail::reversed_bits(detail::pascal_product(i)), second) << i;
  }
}

TEST(Sobol, PutsOnePointInEveryElementaryInterval) {
  for (int pixel = 0; pixel < 20; ++pixel) {
    const Scramble scramble = scramble_of(kSeed, pixel, -3 * pixel, 7);
    for (int m = 0; m <= 12; ++m) {
      for (int a = 0; a <= m; ++a) {
        std::vector<bool> seen(std::size_t{1} << m);
        for (std::uint32_t i = 0; i < 1u << m; ++i) {
          const SquarePoint p = sobol(i, scramble);
          const auto column = static_cast<std::size_t>(std::ldexp(p.u, a));
          const auto row = static_cast<std::size_t>(std::ldexp(p.v, m - a));
          const std::size_t cell = row << a | column;
          ASSERT_FALSE(seen.at(cell)) << "2^" << m << " points, 2^" << a << " columns, cell " << cell;
          seen[cell] = true;
        }
      }
    }
  }
}

TEST(Sobol, DiffersFromPixelToPixelSeedToSeedAndStreamToStream) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
  for (int y = -8; y < 8; ++y) {
    for (int x = -8; x < 8; ++x) {
      for (std::uint32_t stream = 0; stream < 4; ++stream) {
        for (const std::uint64_t seed : {kSeed, kSeed + 1, kSeed + (std::uint64_t{1} << 32)}) {
          const Scramble s = scramble_of(seed, x, y, stream);
          seen.insert({s.first, s.second});
        }
      }
    }
  }
  EXPECT_EQ(seen.size(), 16u * 16 * 4 * 3);
}

TEST(Sobol, IsUniformOverPixelsForEachSampleAlone) {
  constexpr int kPixels = 20000;
  for (const std::uint32_t index : {0u, 1u, 63u}) {
    double sum[2] = {}, squares[2] = {}, product = 0;
    for (int pixel = 0; pixel < kPixels; ++pixel) {
      const SquarePoint p = sobol(index, scramble_of(kSeed, pixel % 200, pixel / 200, 0));
      const double d[2] = {p.u - 0.5, p.v - 0.5};
      for (int k = 0; k < 2; ++k) sum[k] += d[k], squares[k] += d[k] * d[k];
      product += d[0] * d[1];
    }
    for (int k = 0; k < 2; ++k) {
      // Standard errors: of the mean sqrt(1/12 / N), of the variance sqrt(1/180 / N), of d0 d1 1/12 /
      // sqrt(N).
      EXPECT_LT(std::abs(sum[k] / kPixels) / std::sqrt(1.0 / 12 / kPixels), 4) << index;
      EXPECT_LT(std::abs(squares[k] / kPixels - 1.0 / 12) / std::sqrt(1.0 / 180 / kPixels), 4) << index;
    }
    EXPECT_LT(std::abs(product / kPixels) * 12 * std::sqrt(double{kPixels}), 4) << index;
  }
}

/// Root mean square over pixels of the error of a mean over n points of exp(u) sin(pi v).
template <typename PointOf>
double rms_error(std::uint32_t n, const PointOf& point_of) {
  const double truth = (std::exp(1.0) - 1) * 2 / std::acos(-1.0);
  double squares = 0;
  constexpr int kPixels = 100;
  for (int pixel = 0; pixel < kPixels; ++pixel) {
    double sum = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
      const SquarePoint p = point_of(pixel, i);
      sum += std::exp(double{p.u}) * std::sin(std::acos(-1.0) * double{p.v});
    }
    squares += (sum / n - truth) * (sum / n - truth);
  }
  return std::sqrt(squares / kPixels);
}

TEST(Sobol, IntegratesASmoothFunctionFasterThanRandomPoints) {
  const auto scrambled = [](int pixel, std::uint32_t i) { return sobol(i, scramble_of(kSeed, pixel, 0, 0)); };
  const auto random = [](int pixel, std::uint32_t i) {
    const auto bits = philox({static_cast<std::uint32_t>(pixel), i, 0, 0}, {1, 2});
    return SquarePoint{static_cast<float>(uniform(bits[0], bits[1])),
                       static_cast<float>(uniform(bits[2], bits[3]))};
  };
  const double sobol_64 = rms_error(64, scrambled), sobol_1024 = rms_error(1024, scrambled);
  const double random_64 = rms_error(64, random), random_1024 = rms_error(1024, random);
  EXPECT_NEAR(random_64 / random_1024, 4, 1) << "n^-1/2";
  EXPECT_GT(sobol_64 / sobol_1024, 32) << "faster than n^-5/4; Owen proves n^-3/2 but for a logarithm";
  EXPECT_LT(sobol_64, random_64 / 10);
  EXPECT_LT(sobol_1024, random_1024 / 100);
}

}  // namespace
}  // namespace weft::simulator
