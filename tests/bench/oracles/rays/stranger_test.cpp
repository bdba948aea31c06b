// SPDX-License-Identifier: Apache-2.0
// Against the simulator, which traces the same geometry by code of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulator/transport/bounces.h"
#include "simulator/transport/shadows.h"
#include "tests/bench/oracles/rays/traced.h"

namespace weft::test {
namespace {

using namespace solver;

constexpr Size kSize = {56, 56};
constexpr Rect kTile = {20, 20, 36, 36};

/// The cloth in millimetres, as the simulator takes it.
simulator::HeightMesh mesh_of(const TestCloth& cloth) {
  std::vector<Vec3> points_mm;
  for (int y = 0; y < cloth.height_mm.height(); ++y) {
    for (int x = 0; x < cloth.height_mm.width(); ++x) {
      points_mm.push_back({kPitchMm * x, -kPitchMm * y, static_cast<double>(cloth.height_mm(x, y))});
    }
  }
  return *simulator::HeightMesh::build(cloth.pixels(), points_mm);
}

std::vector<Vec3> normals_in(const TestCloth& cloth) {
  std::vector<Vec3> normals;
  for (int y = 0; y < cloth.normal.height(); ++y) {
    for (int x = 0; x < cloth.normal.width(); ++x) {
      normals.push_back(
          normalized({static_cast<double>(cloth.normal(x, y, 0)), static_cast<double>(cloth.normal(x, y, 1)),
                      static_cast<double>(cloth.normal(x, y, 2))}));
    }
  }
  return normals;
}

TEST(Transport, CastsTheShadowsThatTheSimulatorCasts) {
  const TestCloth cloth = bumpy_cloth(kSize);
  const HeightGrid grid = grid_of(cloth, cloth.pixels(), 0);
  const simulator::HeightMesh mesh = mesh_of(cloth);
  int shadowed = 0, differing = 0;
  for (int k = 0; k < 6; ++k) {
    const Vec3 led_mm = 600.0 * direction_of(28, 60.0 * k + 15);
    const LightDirections light = {
        1, [&](std::size_t, int x, int y) {
          const Vec3 place_mm = {kPitchMm * x, -kPitchMm * y, static_cast<double>(cloth.height_mm(x, y))};
          return normalized(led_mm - place_mm);
        }};
    const auto bits = visible_in(grid, cloth, kTile, light, 20);
    const auto truth = *simulator::visible_fraction(mesh, kTile, {led_mm, 0}, {.reach_mm = 20 * kPitchMm});
    for (int y = 0; y < kTile.height(); ++y) {
      for (int x = 0; x < kTile.width(); ++x) {
        const Vec3 l = light.at(0, x + kTile.x0, y + kTile.y0);
        const std::size_t here = static_cast<std::size_t>((y + kTile.y0) * kSize.width + x + kTile.x0);
        if (dot(normals_in(cloth)[here], l) <= 0) continue;  // attached: the simulator leaves it to n . l
        shadowed += truth(x, y) == 0;
        differing += (bits(x, y) == 1) != (truth(x, y) == 1);
      }
    }
  }
  EXPECT_GT(shadowed, 100);
  EXPECT_LE(differing, 3) << "of " << shadowed << " shadowed pixels";
}

// The simulator follows bounces from surface to surface; we look at what the picture has measured of them
// all.
TEST(Transport, FindsTheBouncesOfTheSimulatorInWhatAPictureMeasures) {
  constexpr double kAlbedo = 0.9;
  const TestCloth cloth = bumpy_cloth(kSize);
  const std::vector<Vec3> normals = normals_in(cloth);
  const simulator::HeightMesh mesh = mesh_of(cloth);
  const Vec3 light = direction_of(55, 40);
  std::vector<Rgb> direct, albedo(normals.size(), {kAlbedo, kAlbedo, kAlbedo});
  for (const Vec3 n : normals) {
    const double cosine = std::max(dot(n, light), 0.0);
    direct.push_back({cosine, cosine, cosine});
  }
  const auto bounces = simulator::Bounces::trace(mesh, normals, cloth.pixels(),
                                                 {.rays = 256, .reach_mm = 30 * kPitchMm, .seed = 5});
  ASSERT_TRUE(bounces);
  const auto indirect = *bounces->gather_bounces(direct, albedo, 12);
  std::vector<float> measured;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    measured.push_back(static_cast<float>(kAlbedo * (direct[i][1] + indirect[i][1])));
  }
  const HeightGrid grid = grid_of(cloth, cloth.pixels(), 0);
  const auto found =
      gathered_in(grid, cloth, kTile, {cloth.pixels(), 1, measured}, {.rays = 256, .reach_px = 30});
  double error = 0, squares = 0, mean = 0;
  for (int y = 0; y < kTile.height(); ++y) {
    for (int x = 0; x < kTile.width(); ++x) {
      const std::size_t here = static_cast<std::size_t>((y + kTile.y0) * kSize.width + x + kTile.x0);
      const double difference = static_cast<double>(found(x, y)) - indirect[here][1];
      error += difference / static_cast<double>(kTile.pixels());
      squares += difference * difference / static_cast<double>(kTile.pixels());
      mean += indirect[here][1] / static_cast<double>(kTile.pixels());
    }
  }
  EXPECT_GT(mean, 0.1) << "a cloth with bounces";
  EXPECT_NEAR(error / mean, 0, 0.01);
  EXPECT_LT(std::sqrt(squares) / mean, 0.06);
}

}  // namespace
}  // namespace weft::test
