// SPDX-License-Identifier: Apache-2.0
#include "solver/height/cosine_transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bench/oracles/oracle_rig.h"
#include "core/base/vec.h"

namespace weft::solver {
namespace {

// Lengths of all kinds: 1, powers of two, odd, small primes, products, and primes that go through the chirp.
constexpr std::size_t kLengths[] = {1, 2, 3, 4, 7, 30, 31, 37, 64, 77, 97, 143, 211, 254};

std::vector<double> random_row(std::size_t length, std::uint64_t seed) {
  test::Random random(seed);
  std::vector<double> row(length);
  for (double& v : row) v = random.uniform() - 0.5;
  return row;
}

double worst_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
  return worst;
}

std::vector<double> cosine_sums(const std::vector<double>& row) {
  const std::size_t n = row.size();
  std::vector<double> sums(n);
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      sums[k] += row[i] * std::cos(kPi * static_cast<double>(k * (2 * i + 1) % (4 * n)) /
                                   (2.0 * static_cast<double>(n)));
    }
  }
  return sums;
}

TEST(CosineTransform, IsTheSumOfCosinesForEveryLength) {
  for (const std::size_t length : kLengths) {
    std::vector<double> first = random_row(length, 1), second = random_row(length, 2);
    const std::vector<double> want_first = cosine_sums(first), want_second = cosine_sums(second);
    CosineTransform(length).forward(first.data(), second.data());
    EXPECT_LT(worst_difference(first, want_first), 1e-12) << "length " << length;
    EXPECT_LT(worst_difference(second, want_second), 1e-12) << "length " << length;
  }
}

TEST(CosineTransform, InverseGivesTheRowsBackForEveryLength) {
  for (const std::size_t length : kLengths) {
    const std::vector<double> first = random_row(length, 3), second = random_row(length, 4);
    std::vector<double> a = first, b = second;
    CosineTransform transform(length);
    transform.forward(a.data(), b.data());
    transform.inverse(a.data(), b.data());
    EXPECT_LT(worst_difference(a, first), 1e-13) << "length " << length;
    EXPECT_LT(worst_difference(b, second), 1e-13) << "length " << length;
  }
}

}  // namespace
}  // namespace weft::solver
