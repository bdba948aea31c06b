// SPDX-License-Identifier: Apache-2.0
#include "solver/gates/told_spread.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "core/base/vec.h"
#include "core/image/fourier.h"

namespace weft::solver {
namespace {

// Periods that the side is a multiple of: to wrap around is to go on as before.
constexpr int kWindowSide = 160;
constexpr double kPeriodX = 16, kPeriodY = 20, kSlope = 0.45;

struct Spread {
  double share = 0, mean = 0;
};

// A relief of two sines, or a rib, and its albedo over the height, 0 to 1.
struct Cloth {
  bool is_ribbed = false;
  std::function<double(double height)> albedo = [](double) { return 0.6; };

  double phase_x(int x) const { return 2 * std::numbers::pi * x / kPeriodX; }
  double phase_y(int y) const { return 2 * std::numbers::pi * y / kPeriodY; }
  Vec3 normal(int x, int y) const {
    return normalized({-kSlope * std::cos(phase_x(x)), is_ribbed ? 0 : kSlope * std::cos(phase_y(y)), 1});
  }
  double height(int x, int y) const {
    return is_ribbed ? 0.5 + 0.5 * std::sin(phase_x(x))
                     : 0.5 + 0.25 * (std::sin(phase_x(x)) + std::sin(phase_y(y)));
  }
};

// E of all cells after (1 - share) E + share K * E, by its spectrum.
std::vector<Vec3> seen(const Cloth& cloth, const Spread& spread) {
  std::array<Image<std::complex<float>>, 3> planes = {Image<std::complex<float>>({kWindowSide, kWindowSide}),
                                                      Image<std::complex<float>>({kWindowSide, kWindowSide}),
                                                      Image<std::complex<float>>({kWindowSide, kWindowSide})};
  for (int y = 0; y < kWindowSide; ++y) {
    for (int x = 0; x < kWindowSide; ++x) {
      const Vec3 n = cloth.normal(x, y);
      planes[0](x, y) = static_cast<float>(n.x), planes[1](x, y) = static_cast<float>(n.y);
      planes[2](x, y) = static_cast<float>(n.z);
    }
  }
  const auto wave = [](int k) {
    return (k <= kWindowSide / 2 ? k : k - kWindowSide) / static_cast<double>(kWindowSide);
  };
  for (auto& plane : planes) {
    transform_plane(plane.plane(), 1);
    for (int y = 0; y < kWindowSide; ++y) {
      for (int x = 0; x < kWindowSide; ++x) {
        const double t = 4 * spread.mean * std::hypot(wave(x), wave(y));  // 2 pi l f, l = 2 mean / pi
        const double kept = 1 - spread.share + spread.share / (1 + t * t);
        plane(x, y) = std::conj(plane(x, y)) * static_cast<float>(kept / (kWindowSide * kWindowSide));
      }
    }
    transform_plane(plane.plane(), 1);
  }
  std::vector<Vec3> all;
  for (int y = 0; y < kWindowSide; ++y) {
    for (int x = 0; x < kWindowSide; ++x) {
      const auto real = [&](std::size_t c) { return static_cast<double>(planes[c](x, y).real()); };
      all.push_back({real(0), real(1), real(2)});
    }
  }
  return all;
}

LambertWindow window_of(const Cloth& cloth, const Spread& spread) {
  LambertWindow window = {Image<float>({kWindowSide, kWindowSide}, 3),
                          Image<float>({kWindowSide, kWindowSide})};
  const std::vector<Vec3> light = seen(cloth, spread);
  for (int y = 0; y < kWindowSide; ++y) {
    for (int x = 0; x < kWindowSide; ++x) {
      const Vec3 b = light[static_cast<std::size_t>(y * kWindowSide + x)], n = normalized(b);
      window.normal(x, y, 0) = static_cast<float>(n.x), window.normal(x, y, 1) = static_cast<float>(n.y);
      window.normal(x, y, 2) = static_cast<float>(n.z);
      window.albedo(x, y) = static_cast<float>(cloth.albedo(cloth.height(x, y)) * length(b));
    }
  }
  return window;
}

std::optional<ToldSpread> told(const Cloth& cloth, const Spread& spread, int threads = 1) {
  const std::array<LambertWindow, 1> windows = {window_of(cloth, spread)};
  return told_spread(windows, threads);
}

// Smooth relief of one albedo: what furrows may be brighter by takes some of the share.
TEST(ToldSpread, FindsThatAWeaveSpreadsLightAndNoMoreThanItDoes) {
  for (const Spread& spread : {Spread{0.3, 4.5}, {0.5, 4.5}, {0.5, 6.5}}) {
    const std::optional<ToldSpread> found = told({}, spread);
    ASSERT_TRUE(found) << spread.share << " over " << spread.mean;
    EXPECT_GT(found->share, 0.1) << spread.share << " over " << spread.mean;
    EXPECT_LT(found->share, spread.share + 0.05) << spread.share << " over " << spread.mean;
    EXPECT_GT(found->slope_gain, 1.05);
    EXPECT_GT(found->sure, 4);
    EXPECT_GT(found->sigma_slope, 0);
    EXPECT_LT(found->sigma_slope, 0.2);
  }
}

TEST(ToldSpread, TellsNoneOfClothThatKeepsItsLight) {
  EXPECT_FALSE(told({}, {}));
}

TEST(ToldSpread, TellsNoneWhereFurrowsAreDarkerByThemselves) {
  EXPECT_FALSE(told({.albedo = [](double height) { return 0.6 * (0.9 + 0.1 * height); }}, {}));
}

TEST(ToldSpread, TellsNoneOfARibWhoseSlopesLieInOneDirection) {
  EXPECT_FALSE(told({.is_ribbed = true}, {0.4, 4.5}));
}

TEST(ToldSpread, IsTheSameForAnyNumberOfThreads) {
  const std::array<LambertWindow, 2> windows = {window_of({}, {0.3, 4.5}), window_of({}, {0.4, 4.5})};
  const std::optional<ToldSpread> one = told_spread(windows, 1), three = told_spread(windows, 3);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->share, three->share);
  EXPECT_EQ(one->mean_cells, three->mean_cells);
  EXPECT_EQ(one->sigma_slope, three->sigma_slope);
}

}  // namespace
}  // namespace weft::solver
