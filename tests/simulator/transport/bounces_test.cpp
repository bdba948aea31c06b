// SPDX-License-Identifier: Apache-2.0
#include "simulator/transport/bounces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "simulator/transport/shadows.h"
#include "tests/simulator/transport/surfaces.h"

namespace weft::simulator {
namespace {

constexpr Rgb kWhite = {1, 1, 1};

Bounces traced(const HeightMesh& mesh, const TestSurface& surface, Rect pixels, const RaySettings& settings) {
  auto bounces = Bounces::trace(mesh, surface.normals, pixels, settings);
  EXPECT_TRUE(bounces) << (bounces ? "" : bounces.error().message());
  return *std::move(bounces);
}

std::vector<Rgb> everywhere(const HeightMesh& mesh, Rgb value) {
  return std::vector<Rgb>(mesh.vertices(), value);
}

TEST(Bounces, FindNothingOnAPlane) {
  for (const double tilt_deg : {0.0, 30.0}) {
    const Rect area{-20, -20, 40, 40}, pixels{0, 0, 20, 20};
    const double slope = std::tan(radians(tilt_deg));
    const TestSurface plane = surface_over(area, [&](int x, int y) {
      const double x_mm = 150 + 0.05 * x;
      return std::pair{Vec3{x_mm, 0.05 * y, 2 - slope * x_mm}, normalized({slope, 0, 1})};
    });
    const HeightMesh mesh = plane.mesh();
    const Bounces bounces = traced(mesh, plane, pixels, {.rays = 256, .reach_mm = 0.9});
    const Image<float> openness = bounces.openness();
    const auto light = bounces.gather(everywhere(mesh, kWhite), everywhere(mesh, kWhite));
    ASSERT_TRUE(light);
    for (int y = 0; y < 20; ++y) {
      for (int x = 0; x < 20; ++x) ASSERT_EQ(openness(x, y), 1) << x << ", " << y << ", tilt " << tilt_deg;
    }
    for (const Rgb& e : *light) ASSERT_EQ(e, Rgb{});
  }
}

TEST(Bounces, SeeTheClothBesideANormalThatLeansOverIt) {
  const TestSurface plane = surface_over({-40, -40, 41, 41}, [](int x, int y) {
    return std::pair{Vec3{0.05 * x, 0.05 * y, 0}, Vec3{std::sin(0.5), 0, std::cos(0.5)}};
  });
  const HeightMesh mesh = plane.mesh();
  const Bounces bounces = traced(mesh, plane, {0, 0, 1, 1}, {.rays = 4096, .reach_mm = 1.9});
  EXPECT_NEAR(bounces.openness()(0, 0), (1 + std::cos(0.5)) / 2, 1e-3) << "the sky of a tilted plane";
  EXPECT_EQ(std::count(bounces.met(0, 0).begin(), bounces.met(0, 0).end(), kDark), 0);
}

// The view from a wall of an endless groove to the other wall, from its bottom to its rim, is
// (sin a2 - sin a1) / 2 with angles from the wall's normal (crossed strings, Hottel 1954).
TEST(Bounces, SeeTheOtherWallOfAGrooveByItsFormFactor) {
  constexpr int kHalf = 17;  // columns from bottom to rim; a plain outside
  for (const double slope_deg : {45.0, 65.0}) {
    const double alpha = radians(slope_deg), slope = std::tan(alpha);
    const TestSurface groove = surface_over({-20, -400, 21, 416}, [&](int x, int y) {
      const double x_mm = 50 + x;
      const Vec3 normal = {x < 0 ? std::sin(alpha) : -std::sin(alpha), 0, std::cos(alpha)};
      return std::pair{Vec3{x_mm, 1.0 * y, slope * std::min(std::abs(x), kHalf)}, normal};
    });
    const HeightMesh mesh = groove.mesh();
    const Rect pixels{-16, 0, 0, 16};
    const Bounces bounces = traced(mesh, groove, pixels, {.rays = 1024, .reach_mm = 395, .seed = 3});
    const Rgb irradiance = {1, 2, 0}, albedo = {0.5, 0.25, 1};
    const auto light = bounces.gather(everywhere(mesh, irradiance), everywhere(mesh, albedo));
    ASSERT_TRUE(light);
    const Image<float> openness = bounces.openness();
    double sum = 0, expected_sum = 0;
    for (int y = 0; y < 16; ++y) {
      for (int x = -16; x < 0; ++x) {
        const Vec3 to_rim = normalized({kHalf - 1.0 * x, 0, slope * (kHalf + x)});
        const double factor = (1 - dot(to_rim, {std::cos(alpha), 0, -std::sin(alpha)})) / 2;
        const double found = 1 - static_cast<double>(openness(x + 16, y));
        EXPECT_NEAR(found / factor, 1, 0.04) << "column " << x << " at " << slope_deg;
        const Rgb e = (*light)[mesh.vertex(x, y)];
        EXPECT_NEAR(e[0], 0.5 * found, 1e-6);
        EXPECT_NEAR(e[1], 0.5 * found, 1e-6);
        EXPECT_EQ(e[2], 0);
        sum += found;
        expected_sum += factor;
      }
    }
    EXPECT_NEAR(sum / expected_sum, 1, 0.005) << "mean over 256 points at " << slope_deg;
  }
}

/// The inside of a sphere from its lowest point to `theta` from there, as a mesh in polar coordinates.
TestSurface bowl(double theta, int columns, int rows) {
  return surface_over({0, 0, columns, rows}, [=](int x, int y) {
    const double azimuth = 2 * kPi * (x % (columns - 1)) / (columns - 1), polar = theta * y / (rows - 1);
    const Vec3 out = {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                      -std::cos(polar)};
    return std::pair{5.0 * out, -1.0 * out};
  });
}

// Any two points of a sphere see each other alike: a bounce in a bowl gives the same light everywhere, the
// bowl's share F = (1 - cos theta) / 2 of the sphere times what it had on average.
TEST(Bounces, InABowlMakeTheGeometricSeries) {
  const double theta = radians(75), share = (1 - std::cos(theta)) / 2;
  const TestSurface surface = bowl(theta, 97, 41);
  const HeightMesh mesh = surface.mesh();
  const Bounces bounces = traced(mesh, surface, surface.area, {.rays = 256, .reach_mm = 20, .seed = 9});
  const Rgb albedo = {0.2, 0.5, 1};
  const auto one = bounces.gather(everywhere(mesh, kWhite), everywhere(mesh, albedo));
  const auto all = bounces.gather_bounces(everywhere(mesh, kWhite), everywhere(mesh, albedo), 30);
  ASSERT_TRUE(one && all);
  double squares = 0, mean = 0;
  constexpr int kPoints = 39 * 96;
  for (int y = 1; y < 40; ++y) {
    for (int x = 0; x < 96; ++x) {
      const Rgb e1 = (*one)[mesh.vertex(x, y)], e = (*all)[mesh.vertex(x, y)];
      for (std::size_t c = 0; c < 3; ++c) {
        const double first = albedo[c] * share;
        EXPECT_NEAR(e1[c] / first, 1, 0.12) << x << ", " << y << ", channel " << c;
        EXPECT_NEAR(e[c] / (first / (1 - first)), 1, 0.12) << x << ", " << y << ", channel " << c;
      }
      const double error = e[2] / (share / (1 - share)) - 1;
      mean += error / kPoints;
      squares += error * error / kPoints;
    }
  }
  EXPECT_NEAR(mean, 0, 0.005);
  EXPECT_LT(std::sqrt(squares), 0.03);
}

// With albedo 1 nothing is absorbed: what leaves over all bounces is what came in, no more and no less.
TEST(Bounces, InADeepPitNeitherGainNorLoseEnergy) {
  constexpr int kSide = 41;
  const auto height_mm = [](int x, int y) {
    return -0.5 * (14 - std::min(14, std::max(std::abs(x), std::abs(y))));
  };
  const TestSurface pit = surface_over({-20, -20, kSide - 20, kSide - 20}, [&](int x, int y) {
    const Vec3 gradient = {height_mm(x + 1, y) - height_mm(x - 1, y),
                           height_mm(x, y + 1) - height_mm(x, y - 1), 0};
    return std::pair{Vec3{0.1 * x, 0.1 * y, height_mm(x, y)}, normalized(Vec3{0, 0, 0.2} - gradient)};
  });
  const HeightMesh mesh = pit.mesh();
  const Bounces bounces = traced(mesh, pit, pit.area, {.rays = 128, .reach_mm = 10, .seed = 4});
  const Image<float> openness = bounces.openness();
  std::vector<Rgb> light = everywhere(mesh, kWhite);
  const std::vector<Rgb> albedo = everywhere(mesh, kWhite);
  const auto leaving = [&] {
    double sum = 0;
    for (int y = -20; y < kSide - 20; ++y) {
      for (int x = -20; x < kSide - 20; ++x) {
        const double area = 1 / pit.normals[mesh.vertex(x, y)].z;
        sum += area * light[mesh.vertex(x, y)][0] * static_cast<double>(openness(x + 20, y + 20));
      }
    }
    return sum;
  };
  double in = 0, out = leaving();
  for (const Vec3& n : pit.normals) in += 1 / n.z;
  double most = 1;
  for (int bounce = 0; bounce < 400; ++bounce) {
    auto next = bounces.gather(light, albedo);
    ASSERT_TRUE(next);
    light = *std::move(next);
    double most_now = 0;
    for (const Rgb& e : light) most_now = std::max(most_now, e[0]);
    EXPECT_LE(most_now, most);
    most = most_now;
    out += leaving();
  }
  EXPECT_LT(most, 1e-3) << "what is still in the pit";
  EXPECT_NEAR(out / in, 1, 0.03);
}

TEST(Bounces, MeetTheSameVerticesFromTilesOfAnySize) {
  const Rect pixels{0, 0, 45, 31};
  const RaySettings settings{.rays = 24, .reach_mm = 0.7, .seed = 8, .stream = 2};
  const int halo = halo_for(settings.reach_mm, 0.049);
  const auto albedo_of = [](std::size_t i) { return Rgb{0.5, 0.9, 0.1 + 0.01 * static_cast<double>(i % 7)}; };
  // Two bounces: the tile grown by one halo is traced, on a mesh grown by two.
  const auto run = [&](Rect tile) {
    const TestSurface surface = bumpy_surface(grown(tile, 2 * halo));
    const HeightMesh mesh = surface.mesh();
    const Bounces bounces = traced(mesh, surface, grown(tile, halo), settings);
    std::vector<Rgb> light, albedo;
    for (int y = surface.area.y0; y < surface.area.y1; ++y) {
      for (int x = surface.area.x0; x < surface.area.x1; ++x) {
        const double shading = std::max(0.0, dot(surface.normals[mesh.vertex(x, y)], {0.8, 0, 0.6}));
        light.push_back({shading, 2 * shading, 0.3});
        albedo.push_back(albedo_of(static_cast<std::size_t>(1000 + x)));
      }
    }
    const auto all = bounces.gather_bounces(light, albedo, 2);
    EXPECT_TRUE(all);
    std::vector<Rgb> of_tile;
    std::vector<std::pair<int, int>> met;
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        of_tile.push_back((*all)[mesh.vertex(x, y)]);
        for (const std::uint32_t vertex : bounces.met(x, y)) {
          const int v = static_cast<int>(vertex), width = surface.area.width();
          met.push_back(vertex >= kDark
                            ? std::pair{1000000, v}
                            : std::pair{surface.area.x0 + v % width, surface.area.y0 + v / width});
        }
      }
    }
    return std::pair{of_tile, met};
  };
  const auto [whole_light, whole_met] = run(pixels);
  EXPECT_GT(std::count_if(whole_met.begin(), whole_met.end(), [](auto m) { return m.first != 1000000; }),
            2000);
  for (const Rect tile : {Rect{0, 0, 45, 16}, Rect{13, 3, 30, 22}, Rect{44, 30, 45, 31}}) {
    const auto [light, met] = run(tile);
    std::size_t i = 0;
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x, ++i) {
        const auto at = static_cast<std::size_t>(y * 45 + x);
        ASSERT_TRUE(std::equal(&met[24 * i], &met[24 * i] + 24, &whole_met[24 * at])) << x << ", " << y;
        ASSERT_EQ(light[i], whole_light[at]) << x << ", " << y;
      }
    }
  }
}

TEST(Bounces, HaveTheStatedErrorAtTheDefaultNumberOfRays) {
  const Rect pixels{0, 0, 12, 12};
  const TestSurface surface = bumpy_surface(grown(pixels, 34));
  const HeightMesh mesh = surface.mesh();
  const auto openness_with = [&](int rays, std::uint32_t stream) {
    const RaySettings settings{.rays = rays, .reach_mm = 1.6, .seed = 2, .stream = stream};
    return traced(mesh, surface, pixels, settings).openness();
  };
  const Image<float> reference = openness_with(64 * kBounceRays, 1), found = openness_with(kBounceRays, 2);
  double squares = 0;
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 12; ++x) squares += std::pow(found(x, y) - reference(x, y), 2.0) / 144;
  }
  EXPECT_LT(std::sqrt(squares), 0.02);
  EXPECT_GT(std::sqrt(squares), 0.005) << "the default would be wasteful";
}

TEST(Bounces, RefuseWhatTheyCannotTrace) {
  const TestSurface surface = bumpy_surface({0, 0, 8, 8});
  const HeightMesh mesh = surface.mesh();
  const auto why = [&](const std::vector<Vec3>& normals, Rect pixels, const RaySettings& settings) {
    const auto bounces = Bounces::trace(mesh, normals, pixels, settings);
    if (bounces) return std::string("accepted");
    EXPECT_EQ(bounces.error().kind, ErrorKind::kBadData);
    return bounces.error().why;
  };
  const RaySettings settings{.rays = 4, .reach_mm = 1};
  std::vector<Vec3> normals = surface.normals;
  EXPECT_EQ(why(normals, surface.area, settings), "accepted");
  EXPECT_EQ(why(normals, surface.area, {.rays = kMostRays + 1, .reach_mm = 1}), "1048577 rays a pixel");
  EXPECT_EQ(why(normals, surface.area, {.rays = 4, .reach_mm = -1}), "a reach of -1 mm");
  EXPECT_THAT(why(normals, {-1, 0, 2, 2}, settings), testing::HasSubstr("[-1, 2) x [0, 2)"));
  normals[9] = {0, 0, 0};
  EXPECT_EQ(why(normals, surface.area, settings), "normal 9 is (0, 0, 0)");
  normals[9] = {0, std::numeric_limits<double>::quiet_NaN(), 1};
  EXPECT_EQ(why(normals, surface.area, settings), "normal 9 is (0, nan, 1)");
  normals.pop_back();
  EXPECT_EQ(why(normals, surface.area, settings), "63 normals for 64 vertices");

  const Bounces bounces = traced(mesh, surface, surface.area, settings);
  std::vector<Rgb> light = everywhere(mesh, kWhite);
  EXPECT_FALSE(bounces.gather(std::vector<Rgb>(63), light));
  light[5][1] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(bounces.gather(light, everywhere(mesh, kWhite)));
  EXPECT_FALSE(bounces.gather_bounces(everywhere(mesh, kWhite), light, 2));
}

}  // namespace
}  // namespace weft::simulator
