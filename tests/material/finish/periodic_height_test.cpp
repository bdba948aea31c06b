// SPDX-License-Identifier: Apache-2.0
#include "material/finish/periodic_height.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/vec.h"

namespace weft::material {
namespace {

TEST(PeriodicHeight, IsTheOneWhoseSlopesTheseAre) {
  const Size size = {101, 72};
  const double mean_right = 0.2, mean_up = -0.1;
  const auto phase = [&](int x, int y) {
    return 2 * kPi * (7.0 * x / size.width - 5.0 * y / size.height) + 0.4;
  };
  const double u = 2 * kPi * 7 / size.width, v = 2 * kPi * 5 / size.height;  // v per pixel upwards
  Image<float> slope(size, 2);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      slope(x, y, 0) = static_cast<float>(1.5 * u * std::cos(phase(x, y)) + mean_right);
      slope(x, y, 1) = static_cast<float>(1.5 * v * std::cos(phase(x, y)) + mean_up);
    }
  }
  const PeriodicHeight found = periodic_height(slope, 2);
  EXPECT_NEAR(found.mean_right, mean_right, 1e-6);
  EXPECT_NEAR(found.mean_up, mean_up, 1e-6);
  double worst = 0, worst_slope = 0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      worst =
          std::max(worst, std::abs(static_cast<double>(found.height(x, y)) - 1.5 * std::sin(phase(x, y))));
      worst_slope = std::max(
          worst_slope, std::abs(static_cast<double>(found.slope(x, y, 0) - slope(x, y, 0)) + mean_right));
      worst_slope = std::max(worst_slope,
                             std::abs(static_cast<double>(found.slope(x, y, 1) - slope(x, y, 1)) + mean_up));
    }
  }
  EXPECT_LT(worst, 3e-6);
  EXPECT_LT(worst_slope, 2e-6);
}

TEST(PeriodicHeight, OfACurlIsLevel) {
  const Size size = {64, 48};
  Image<float> slope(size, 2);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      slope(x, y, 0) = static_cast<float>(std::sin(2 * kPi * 3 * y / size.height));
      slope(x, y, 1) = static_cast<float>(std::sin(2 * kPi * 4 * x / size.width));
    }
  }
  const PeriodicHeight found = periodic_height(slope);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) ASSERT_NEAR(found.height(x, y), 0, 1e-6);
  }
}

TEST(PeriodicHeight, OfOnePixelIsZero) {
  const PeriodicHeight found = periodic_height(Image<float>({1, 1}, 2));
  EXPECT_EQ(found.height(0, 0), 0);
}

TEST(PeriodicHeight, IsTheSameForAnyNumberOfThreads) {
  Image<float> slope({37, 59}, 2);
  for (int p = 0; p < 2; ++p) {
    for (int y = 0; y < 59; ++y) {
      for (int x = 0; x < 37; ++x) slope(x, y, p) = static_cast<float>((x * 7 + y * 13 + p * 5) % 11) / 11;
    }
  }
  const PeriodicHeight one = periodic_height(slope, 1), many = periodic_height(slope, 6);
  for (int y = 0; y < 59; ++y) {
    for (int x = 0; x < 37; ++x) ASSERT_EQ(one.height(x, y), many.height(x, y)) << x << ", " << y;
  }
}

}  // namespace
}  // namespace weft::material
