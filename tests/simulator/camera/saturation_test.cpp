// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/saturation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "tests/simulator/camera/frame.h"

namespace weft::simulator {
namespace {

TEST(NonLinearity, IsUndoneByTheLinearityOfACalibration) {
  for (const auto& [a, b] : {std::array{0.0, 0.0},
                             {-0.02, 0.01},
                             {0.3, -0.2},
                             {-0.44, 0.0},
                             {0.0, -0.29},
                             {1.7, 0.5},
                             {-1.0, 0.45}}) {
    const auto curve = NonLinearity::of({a, b});
    ASSERT_TRUE(curve.has_value()) << a << ", " << b;
    for (int i = -250; i <= 1000; ++i) {
      const double v = i / 1000.0, signal = v * (1 + a * v + b * v * v);
      const double back = curve->distorted(signal);
      ASSERT_NEAR(back, v, 1e-14) << a << ", " << b;
      ASSERT_NEAR(back * (1 + a * back + b * back * back), signal, 1e-14);
    }
  }
}

TEST(NonLinearity, RisesAndStaysFiniteForAnySignal) {
  const NonLinearity curve = *NonLinearity::of({-0.3, 0.05});
  double last = -1e300;
  for (const double signal : {-1e12, -1.0, -0.3, -0.1, 0.0, 0.5, 0.749, 0.75, 0.751, 1.0, 50.0, 1e12}) {
    const double v = curve.distorted(signal);
    ASSERT_TRUE(std::isfinite(v));
    ASSERT_GT(v, last) << signal;
    last = v;
  }
  EXPECT_EQ(curve.distorted(0), 0);
  EXPECT_EQ(NonLinearity::of({0, 0})->distorted(0.3), 0.3);
}

TEST(NonLinearity, RefusesCountsThatFallWithLight) {
  for (const auto& coefficients : {std::array{-0.5, 0.0},
                                   {0.0, -0.4},
                                   {3.0, 0.0},
                                   {-1.5, 0.75},
                                   {std::nan(""), 0.0},
                                   {0.0, std::nan("")}}) {
    const auto curve = NonLinearity::of(coefficients);
    ASSERT_FALSE(curve.has_value()) << coefficients[0] << ", " << coefficients[1];
    EXPECT_EQ(curve.error().kind, ErrorKind::kBadData);
    EXPECT_THAT(curve.error().message(), testing::HasSubstr("do not rise with light"));
  }
}

/// Columns `in` with room for the kernel above and below.
std::vector<double> bloomed(const BloomKernel& kernel, const std::vector<double>& in, int width) {
  std::vector<double> out(in.size() - 2 * index(kernel.radius() * width));
  bloom(kernel, 1, in, {0, 0, width, static_cast<int>(out.size()) / width}, out);
  return out;
}

TEST(Bloom, SpillsTheExcessAlongTheColumnAndLosesNone) {
  const BloomKernel kernel = bloom_kernel({1, 0.5});
  const int r = kernel.radius(), height = 4 * r + 1;
  EXPECT_EQ(r, 10) << "0.5^10 is under a thousandth";
  std::vector<double> in(index(3 * height), 0.25);
  in[index(3 * (2 * r) + 1)] = 5;
  const std::vector<double> out = bloomed(kernel, in, 3);
  const auto at = [&](int x, int y) { return out[index(3 * (y + r) + x)]; };
  EXPECT_EQ(at(1, 0), 1) << "full";
  double spilled = 0;
  for (int y = 1; y <= r; ++y) {
    EXPECT_DOUBLE_EQ(at(1, y), at(1, -y));
    if (y > 1) {
      EXPECT_NEAR((at(1, y) - 0.25) / (at(1, y - 1) - 0.25), 0.5, 1e-12);
    }
    spilled += at(1, y) + at(1, -y) - 0.5;
    EXPECT_EQ(at(0, y), 0.25);
    EXPECT_EQ(at(2, y), 0.25);
  }
  EXPECT_NEAR(spilled, 4, 1e-12) << "all of the excess";
}

TEST(Bloom, DrainsWhatItsShareLeaves) {
  for (const double share : {0.25, 1.0})
    for (const double decay : {0.0, 0.5, 0.9}) {
      const BloomKernel kernel = bloom_kernel({share, decay});
      EXPECT_NEAR(std::accumulate(kernel.weights.begin(), kernel.weights.end(), 0.0), share / 2, 1e-14);
      EXPECT_LE(kernel.radius(), 66);
    }
  EXPECT_EQ(bloom_kernel({}).radius(), 0);
  EXPECT_EQ(bloomed(bloom_kernel({}), {0.5, 3, -0.1}, 1), (std::vector<double>{0.5, 1, -0.1}));
}

}  // namespace
}  // namespace weft::simulator
