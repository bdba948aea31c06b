// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/optics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "core/base/vec.h"
#include "tests/simulator/camera/frame.h"

namespace weft::simulator {
namespace {

CameraModel camera() {
  return overhead_camera(kFrame, 600, 0.08);
}

TEST(Vignette, IsTheFourthPowerOfTheCosine) {
  const Vignette vignette({}, camera());
  EXPECT_EQ(vignette.gain(1231.5, 815.5), 1);
  for (const double angle_deg : {1.0, 5.0, 9.0}) {
    const double r = 7500 * std::tan(radians(angle_deg));
    EXPECT_NEAR(vignette.gain(1231.5 + r, 815.5), std::pow(std::cos(radians(angle_deg)), 4), 1e-14);
    EXPECT_NEAR(vignette.gain(1231.5, 815.5 - r), std::pow(std::cos(radians(angle_deg)), 4), 1e-14);
  }
}

TEST(Vignette, LosesItsShareInTheCorner) {
  const Vignette vignette({0, 0.4}, camera());
  EXPECT_NEAR(vignette.gain(0, 0), 0.6, 1e-15);
  EXPECT_NEAR(vignette.gain(2463, 1631), 0.6, 1e-15);
  EXPECT_NEAR(vignette.gain(1231.5 / 2, 815.5 / 2), 0.9, 1e-15);
  EXPECT_GT(vignette.gain(-1e5, 1e5), 0) << "beyond the frame";
  EXPECT_NEAR(Vignette({3, 0}, camera()).gain(0, 0), std::pow(Vignette({4, 0}, camera()).gain(0, 0), 0.75),
              1e-14);
}

TEST(GainFit, CarriesEveryVignetteInTheSplineOfACalibration) {
  CameraModel wide = overhead_camera(kFrame, 600, 0.4);  // 45 degrees to the corner
  wide.cx += 200;
  for (const VignetteSettings& settings : {VignetteSettings{4, 0}, VignetteSettings{4, 0.5}})
    for (const CameraModel& each : {camera(), wide}) {
      const GainFit fit = fit_gain(Vignette(settings, each), kFrame);
      EXPECT_LT(fit.max_error, 1e-4) << "corner loss " << settings.corner_loss << ", cx " << each.cx;
    }
}

TEST(GainFit, HasMeanZeroOverTheFrameAndGivesTheGainBack) {
  const Vignette vignette({4, 0.3}, camera());
  const GainFit fit = fit_gain(vignette, kFrame);
  double mean = 0;
  constexpr int kSide = 200;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const double u = (2 * i + 1.0) / kSide - 1, v = (2 * j + 1.0) / kSide - 1;
      mean += fit.spline.at(u, v) / (kSide * kSide);
      const double gain = vignette.gain((u + 1) / 2 * 2463, (v + 1) / 2 * 1631);
      ASSERT_NEAR(std::exp(fit.mean_log_gain + fit.spline.at(u, v)), gain, 1e-4 * gain);
    }
  EXPECT_NEAR(mean, 0, 1e-4);
}

double weight(const BlurKernel& kernel, int x, int y) {
  return kernel.weights[index((y + kernel.radius) * (2 * kernel.radius + 1) + x + kernel.radius)];
}

/// Second moment along x.
double variance_of(const BlurKernel& kernel) {
  double variance = 0;
  for (int y = -kernel.radius; y <= kernel.radius; ++y)
    for (int x = -kernel.radius; x <= kernel.radius; ++x) variance += x * x * weight(kernel, x, y);
  return variance;
}

TEST(BlurKernel, KeepsTheEnergyAndTheSymmetryOfThePicture) {
  for (const BlurSettings& settings :
       {BlurSettings{}, BlurSettings{3.7}, BlurSettings{0, 1.2}, BlurSettings{0.4, 0.3},
        BlurSettings{6.3, 0.8, 0.1, 12.5}, BlurSettings{0, 0, 0.5, 1}}) {
    const BlurKernel kernel = blur_kernel(settings);
    const double sum = std::accumulate(kernel.weights.begin(), kernel.weights.end(), 0.0);
    EXPECT_NEAR(sum, 1, 1e-14);
    for (int y = 0; y <= kernel.radius; ++y)
      for (int x = 0; x <= kernel.radius; ++x) {
        const double w = weight(kernel, x, y);
        ASSERT_GE(w, 0);
        for (const double other : {weight(kernel, -x, y), weight(kernel, x, -y), weight(kernel, y, x)})
          ASSERT_EQ(other, w) << x << ", " << y;
      }
  }
}

TEST(BlurKernel, OfASharpLensChangesNothing) {
  EXPECT_EQ(blur_kernel({}).radius, 0);
  EXPECT_EQ(blur_kernel({}).weights, std::vector<double>{1});
  EXPECT_EQ(blur_kernel({.defocus_px = 0.9}).radius, 0) << "the disc lies inside one pixel";
}

TEST(BlurKernel, OfDefocusIsTheAreaOfADiscInEachPixel) {
  const double radius = 3.3, whole = kPi * radius * radius;
  const BlurKernel kernel = blur_kernel({.defocus_px = 2 * radius});
  EXPECT_NEAR(weight(kernel, 0, 0), 1 / whole, 1e-14) << "a pixel inside";
  EXPECT_EQ(weight(kernel, 3, 3), 0) << "a pixel outside";
  for (const auto& [x, y] : {std::pair{3, 0}, {3, 1}, {2, 2}, {0, 3}}) {
    int hits = 0;
    constexpr int kSide = 2000;
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i)
        hits += std::hypot(x - 0.5 + (i + 0.5) / kSide, y - 0.5 + (j + 0.5) / kSide) <= radius;
    EXPECT_NEAR(weight(kernel, x, y), hits / (whole * kSide * kSide), 1e-5) << x << ", " << y;
  }
}

TEST(BlurKernel, HasTheVarianceOfItsDiscAndGaussianAndPixels) {
  // A disc of diameter d has the variance d^2 / 16 along x, the square of a pixel 1 / 12.
  EXPECT_NEAR(variance_of(blur_kernel({.defocus_px = 8})), 4 + 1.0 / 12, 0.03);
  EXPECT_NEAR(variance_of(blur_kernel({.spread_px = 1.5})), 2.25 + 1.0 / 12, 0.01);
  EXPECT_NEAR(variance_of(blur_kernel({.defocus_px = 8, .spread_px = 1.5})), 6.25 + 2.0 / 12, 0.03);
}

TEST(BlurKernel, PutsItsShareIntoTheHalo) {
  const BlurKernel kernel = blur_kernel({.halo_share = 0.2, .halo_radius_px = 10});
  EXPECT_NEAR(weight(kernel, 0, 0), 0.8 + 0.2 / (100 * kPi), 1e-12);
  EXPECT_NEAR(weight(kernel, 6, 5), 0.2 / (100 * kPi), 1e-12);
}

TEST(Convolve, GivesTheSameNumbersForEveryTile) {
  const BlurKernel kernel = blur_kernel({.defocus_px = 3, .spread_px = 0.7});
  const int r = kernel.radius;
  const auto light = [](int x, int y, int c) { return 1 + std::sin(0.7 * x + 1.3 * y * (c + 1)); };
  const auto blurred = [&](Rect rect) {
    std::vector<double> in, out(static_cast<std::size_t>(3 * rect.pixels()));
    for (int y = rect.y0 - r; y < rect.y1 + r; ++y)
      for (int x = rect.x0 - r; x < rect.x1 + r; ++x)
        for (int c = 0; c < 3; ++c) in.push_back(light(x, y, c));
    convolve(kernel, in, rect, 3, out);
    return out;
  };
  const Rect whole = {-2, 3, 21, 20};
  const std::vector<double> all = blurred(whole);
  for (const Rect& part : {Rect{-2, 3, -1, 4}, Rect{5, 7, 12, 20}, Rect{0, 10, 21, 11}}) {
    const std::vector<double> some = blurred(part);
    std::size_t i = 0;
    for (int y = part.y0; y < part.y1; ++y)
      for (int x = part.x0; x < part.x1; ++x)
        for (int c = 0; c < 3; ++c, ++i)
          ASSERT_EQ(some[i], all[index(((y - whole.y0) * whole.width() + x - whole.x0) * 3 + c)]);
  }
}

TEST(Convolve, SpreadsAPointAsTheKernelSaysAndKeepsEvenLight) {
  const BlurKernel kernel = blur_kernel({.defocus_px = 4.2, .spread_px = 0.5});
  const int r = kernel.radius, side = 4 * r + 1;
  std::vector<double> in(index(side * side));
  in[index(2 * r * side + 2 * r)] = 1;
  std::vector<double> out(kernel.weights.size());
  convolve(kernel, in, {0, 0, 2 * r + 1, 2 * r + 1}, 1, out);
  EXPECT_EQ(out, kernel.weights);
  convolve(kernel, std::vector<double>(in.size(), 0.25), {0, 0, 2 * r + 1, 2 * r + 1}, 1, out);
  for (const double sample : out) ASSERT_NEAR(sample, 0.25, 1e-14);
}

}  // namespace
}  // namespace weft::simulator
