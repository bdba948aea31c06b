// SPDX-License-Identifier: Apache-2.0
// Lateral colour, field curvature and veiling glare on pictures of a few points.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "simulator/camera/field_curvature.h"
#include "simulator/camera/lateral_colour.h"
#include "simulator/camera/lens_veil.h"

namespace weft::simulator {
namespace {

constexpr Size kSmall = {201, 151};
constexpr double kCorner_px = 125;  // hypot(100, 75)

CameraModel centred() {
  CameraModel camera;
  camera.size = kSmall;
  camera.fx = camera.fy = 500;
  camera.cx = 100;
  camera.cy = 75;
  return camera;
}

Rect around_frame(int px) {
  return {-px, -px, kSmall.width + px, kSmall.height + px};
}

std::size_t at(Rect rect, int x, int y) {
  return static_cast<std::size_t>((y - rect.y0) * rect.width() + x - rect.x0);
}

/// A soft spot of light; a sharp one would not be seen between the pixels.
std::vector<Rgb> spot(Rect rect, double x0, double y0) {
  std::vector<Rgb> light(static_cast<std::size_t>(rect.pixels()));
  for (int y = rect.y0; y < rect.y1; ++y) {
    for (int x = rect.x0; x < rect.x1; ++x)
      light[at(rect, x, y)].fill(std::exp(-std::pow(x - x0, 2) / 8 - std::pow(y - y0, 2) / 8));
  }
  return light;
}

/// Centre of mass of one channel.
Vec3 centre_of(const std::vector<Rgb>& light, Rect rect, std::size_t c) {
  Vec3 sum;
  double mass = 0;
  for (int y = rect.y0; y < rect.y1; ++y) {
    for (int x = rect.x0; x < rect.x1; ++x) {
      const double here = light[at(rect, x, y)][c];
      sum = sum + here * Vec3{1.0 * x, 1.0 * y, 0};
      mass += here;
    }
  }
  return (1 / mass) * sum;
}

TEST(LateralColour, MovesAPointOfTheCornerByThePixelsItSaysAndGreenByNone) {
  const LateralColour lens({0.7, -0.4}, centred());
  const Rect out_rect = around_frame(0), in_rect = around_frame(lens.reach());
  std::vector<Rgb> seen(static_cast<std::size_t>(out_rect.pixels()));
  const double x0 = 12, y0 = 9;  // 110 pixels from the axis, towards the upper left corner
  lens.image(spot(in_rect, x0, y0), in_rect, out_rect, seen);
  const auto outwards = [&](std::size_t c) {
    const Vec3 centre = centre_of(seen, out_rect, c);
    return ((x0 - centre.x) * 0.8 + (y0 - centre.y) * 0.6);
  };
  EXPECT_NEAR(outwards(0), 0.7 * 110 / kCorner_px, 0.01);
  EXPECT_NEAR(outwards(1), 0, 1e-3);
  EXPECT_NEAR(outwards(2), -0.4 * 110 / kCorner_px, 0.01);
}

TEST(LateralColour, LooksExactlyWhereItSaysOnAPictureThatIsASlope) {
  const LateralColour lens({1.3, 0}, centred());
  const Rect out_rect = around_frame(0), in_rect = around_frame(lens.reach());
  std::vector<Rgb> slope(static_cast<std::size_t>(in_rect.pixels()));
  for (int y = in_rect.y0; y < in_rect.y1; ++y)
    for (int x = in_rect.x0; x < in_rect.x1; ++x) slope[at(in_rect, x, y)].fill(3.0 * x + 2.0 * y);
  std::vector<Rgb> seen(static_cast<std::size_t>(out_rect.pixels()));
  lens.image(slope, in_rect, out_rect, seen);
  for (const auto& [x, y] : {std::pair{0, 0}, {200, 150}, {100, 75}, {37, 120}}) {
    const double nearer = 1 - 1.3 / kCorner_px;
    const double expected = 3 * (100 + nearer * (x - 100)) + 2 * (75 + nearer * (y - 75));
    EXPECT_NEAR(seen[at(out_rect, x, y)][0], expected, 1e-9) << x << ", " << y;
    EXPECT_EQ(seen[at(out_rect, x, y)][1], 3.0 * x + 2.0 * y);
  }
}

TEST(FieldCurvature, HasADiscThatGrowsWithTheSquareOfTheRadius) {
  const FieldCurvature lens({6}, centred());
  EXPECT_EQ(lens.diameter_px(100, 75), 0);
  EXPECT_NEAR(lens.diameter_px(0, 0), 6, 1e-12);
  EXPECT_NEAR(lens.diameter_px(100 + 30, 75 - 40), 6 * 50 * 50 / (kCorner_px * kCorner_px), 1e-12);
  EXPECT_NEAR(lens.diameter_px(-50, -50), 6, 1e-12) << "beyond the corner";
}

TEST(FieldCurvature, SpreadsAPointAsADiscOfThatDiameterAndKeepsEvenLight) {
  const FieldCurvature lens({6}, centred());
  const Rect out_rect = around_frame(0), in_rect = around_frame(lens.radius());
  std::vector<Rgb> light(static_cast<std::size_t>(in_rect.pixels())), seen;
  light[at(in_rect, 20, 15)] = {1, 1, 1};
  seen.resize(static_cast<std::size_t>(out_rect.pixels()));
  lens.blur(light, in_rect, out_rect, seen);
  double sum = 0, squares = 0;
  for (int y = 0; y < kSmall.height; ++y) {
    for (int x = 0; x < kSmall.width; ++x) {
      sum += seen[at(out_rect, x, y)][1];
      squares += seen[at(out_rect, x, y)][1] * (std::pow(x - 20, 2) + std::pow(y - 15, 2));
    }
  }
  const double diameter_px = lens.diameter_px(20, 15);
  EXPECT_NEAR(sum, 1, 0.01);
  // A disc has a mean square radius of d^2 / 8, the pixel adds 1 / 6.
  EXPECT_NEAR(squares / sum, diameter_px * diameter_px / 8 + 1.0 / 6, 0.05);
  for (Rgb& each : light) each.fill(0.7);
  lens.blur(light, in_rect, out_rect, seen);
  for (const Rgb& each : seen) ASSERT_NEAR(each[2], 0.7, 1e-12);
}

TEST(Veil, OfAnEvenFrameIsItsShareEverywhere) {
  FrameLight light({1000, 700});
  for (int row = 0; row < light.rows(); ++row)
    for (int column = 0; column < light.columns(); ++column) light.mean(column, row) = {0.5, 0.25, 1};
  const FrameLight veil = veil_of({0.02, 0.1}, light);
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {999.0, 699.0}, {500.0, 3.0}}) {
    EXPECT_NEAR(veil.at(x, y)[0], 0.01, 1e-12);
    EXPECT_NEAR(veil.at(x, y)[1], 0.005, 1e-12);
    EXPECT_NEAR(veil.at(x, y)[2], 0.02, 1e-12);
  }
}

TEST(Veil, FallsOffBesideALightAsItsGaussianDoes) {
  FrameLight light({640, 640});
  light.mean(16, 16).fill(1);
  const FrameLight veil = veil_of({0.1, 0.1}, light);
  const double sigma_px = 0.1 * 640 * std::sqrt(2), way_px = 5 * 20;  // five cells of 20 pixels
  EXPECT_NEAR(
      veil.at(16.5 * 20 - 0.5 + way_px, 16.5 * 20 - 0.5)[0] / veil.at(16.5 * 20 - 0.5, 16.5 * 20 - 0.5)[0],
      std::exp(-way_px * way_px / (2 * sigma_px * sigma_px)), 0.01);
}

}  // namespace
}  // namespace weft::simulator
