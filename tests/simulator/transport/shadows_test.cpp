// SPDX-License-Identifier: Apache-2.0
#include "simulator/transport/shadows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "tests/simulator/transport/surfaces.h"

namespace weft::simulator {
namespace {

constexpr double kReachMm = 1.6;
const SphereLight kLed = {{380, -20, 190}, 5};

Image<float> seen(const HeightMesh& mesh, Rect pixels, const SphereLight& light,
                  const RaySettings& settings) {
  auto fraction = visible_fraction(mesh, pixels, light, settings);
  EXPECT_TRUE(fraction) << (fraction ? "" : fraction.error().message());
  return *std::move(fraction);
}

TEST(Shadows, LeaveAPlaneAllLit) {
  for (const double tilt_deg : {0.0, 35.0}) {
    const Rect area{0, 0, 60, 60};
    const double slope = std::tan(radians(tilt_deg));
    const HeightMesh mesh = surface_over(area, [&](int x, int y) {
                              const double x_mm = 150 + 0.05 * x;
                              return std::pair{Vec3{x_mm, 0.05 * y, 2 - slope * x_mm}, Vec3{0, 0, 1}};
                            }).mesh();
    for (const double radius_mm : {0.0, 5.0}) {
      const SphereLight light{{500, 50, 60}, radius_mm};
      const Image<float> fraction = seen(mesh, area, light, {.rays = 16, .reach_mm = kReachMm});
      for (int y = 0; y < 60; ++y) {
        for (int x = 0; x < 60; ++x) ASSERT_EQ(fraction(x, y), 1) << x << ", " << y << ", " << radius_mm;
      }
    }
  }
}

/// A shelf of height 2 mm for x <= 0, a plane at 0 for x > 0.
constexpr double kShelfMm = 2;
TestSurface shelf(Rect area, double step_x_mm, double step_y_mm) {
  return surface_over(area, [&](int x, int y) {
    return std::pair{Vec3{step_x_mm * x, step_y_mm * y, x <= 0 ? kShelfMm : 0.0}, Vec3{0, 0, 1}};
  });
}

TEST(Shadows, EndWhereAWallsEdgePutsThem) {
  constexpr double kStepMm = 0.05;
  const HeightMesh mesh = shelf({-100, -2, 200, 3}, kStepMm, kStepMm).mesh();
  for (const double led_x_mm : {-100.0, -300.0, -700.0}) {
    const SphereLight light{{led_x_mm, 0, 300}, 0};
    const Image<float> fraction = seen(mesh, {1, 0, 200, 1}, light, {.reach_mm = 6});
    const double edge_mm = kShelfMm * -led_x_mm / (300 - kShelfMm);
    int dark = 0;
    while (fraction(dark, 0) == 0) ++dark;
    for (int x = 0; x < 199; ++x) EXPECT_EQ(fraction(x, 0), x < dark ? 0 : 1);
    EXPECT_NEAR((dark + 0.5) * kStepMm, edge_mm, kStepMm);
  }
}

TEST(Shadows, AreNotCastFromBeyondTheReach) {
  const HeightMesh mesh = shelf({-100, -2, 200, 3}, 0.05, 0.05).mesh();
  const SphereLight light{{-700, 0, 300}, 0};  // the shadow is 4.7 mm wide
  const Image<float> fraction = seen(mesh, {1, 0, 200, 1}, light, {.reach_mm = 2});
  for (int x = 1; x < 200; ++x) {
    const double from_wall_mm = 0.05 * x - 2;
    if (std::abs(from_wall_mm) < 0.06) continue;
    EXPECT_EQ(fraction(x - 1, 0), from_wall_mm < 0 ? 0 : 1) << x;
  }
}

/// The part of a disc of radius 1 on one side of a chord at distance t from its centre.
double part_of_disc(double t) {
  return (std::acos(-t) + t * std::sqrt(1 - t * t)) / kPi;
}

TEST(Shadows, HaveThePenumbraOfTheLedsSize) {
  constexpr double kStepMm = 0.01;
  const HeightMesh mesh = shelf({-40, -12, 320, 13}, kStepMm, 0.05).mesh();
  const SphereLight light{{-298, 0, 300}, 20};
  const Image<float> fraction = seen(mesh, {1, 0, 320, 1}, light, {.rays = 1024, .reach_mm = 3.3});
  const auto position_mm = [&](double level) {
    int x = 0;
    while (fraction(x + 1, 0) < level) ++x;
    return kStepMm * (x + 1 + (level - fraction(x, 0)) / (fraction(x + 1, 0) - fraction(x, 0)));
  };
  // The planes through the edge that touch the sphere, at 45 degrees +- beta, meet the table there.
  const double beta = std::asin(light.radius_mm / std::hypot(298, 298));
  const double full_mm = kShelfMm * (std::tan(kPi / 4 + beta) - std::tan(kPi / 4 - beta));
  double t = 0;
  for (double step = 0.5; step > 1e-9; step /= 2) t += part_of_disc(t) < 0.9 ? step : -step;
  EXPECT_NEAR(t, 0.687, 1e-3);
  const double width_mm = (position_mm(0.9) - position_mm(0.1)) / t;
  EXPECT_NEAR(width_mm / full_mm, 1, 0.01) << width_mm << " mm of " << full_mm;
  EXPECT_NEAR(position_mm(0.5), kShelfMm * (std::tan(kPi / 4)), kStepMm);
}

TEST(Shadows, AreTheSameBytesFromTilesOfAnySize) {
  const Rect pixels{0, 0, 90, 61};
  const int halo = halo_for(kReachMm, 0.049);
  const TestSurface whole = bumpy_surface(grown(pixels, halo));
  const HeightMesh mesh = whole.mesh();
  for (const double radius_mm : {0.0, 5.0}) {
    const SphereLight light{kLed.position_mm, radius_mm};
    const RaySettings settings{.rays = 10, .reach_mm = kReachMm, .seed = 5, .stream = 3};
    const Image<float> expected = seen(mesh, pixels, light, settings);
    int partly = 0;
    for (const Rect tile :
         {Rect{0, 0, 90, 61}, Rect{17, 3, 58, 40}, Rect{58, 40, 59, 41}, Rect{64, 0, 90, 61}}) {
      const HeightMesh part = bumpy_surface(grown(tile, halo)).mesh();
      const Image<float> fraction = seen(part, tile, light, settings);
      for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) {
          const float f = fraction(x - tile.x0, y - tile.y0);
          ASSERT_EQ(f, expected(x, y)) << x << ", " << y;
          partly += f < 1;
        }
      }
    }
    EXPECT_GT(partly, 500);
  }
}

TEST(Shadows, AreTheSameBytesFromManyThreads) {
  constexpr int kTile = 12;
  const RaySettings settings{.rays = 16, .reach_mm = 0.4, .seed = 5};
  const int halo = halo_for(settings.reach_mm, 0.049);
  const auto run = [&](int threads) {
    std::vector<float> fractions(16 * kTile * kTile);
    parallel_for(16, threads, [&](std::size_t i, int) {
      const int x0 = static_cast<int>(i % 4) * kTile, y0 = static_cast<int>(i / 4) * kTile;
      const Rect tile{x0, y0, x0 + kTile, y0 + kTile};
      const auto mesh = HeightMesh::build(grown(tile, halo), bumpy_surface(grown(tile, halo)).points_mm);
      if (!mesh) return;
      const auto fraction = visible_fraction(*mesh, tile, kLed, settings);
      for (int y = 0; fraction && y < kTile; ++y) {
        for (int x = 0; x < kTile; ++x) {
          fractions[i * kTile * kTile + static_cast<std::size_t>(y * kTile + x)] = 1 + (*fraction)(x, y);
        }
      }
    });
    return fractions;
  };
  const std::vector<float> alone = run(1);
  EXPECT_EQ(std::count(alone.begin(), alone.end(), 0.0f), 0);
  EXPECT_EQ(run(4), alone);
}

TEST(Shadows, HaveTheirOwnNoiseForEachSeedAndLed) {
  const Rect pixels{0, 0, 40, 40};
  const HeightMesh mesh = bumpy_surface(grown(pixels, 33)).mesh();
  const SphereLight light{kLed.position_mm, 40};
  const auto differing = [&](const RaySettings& a, const RaySettings& b) {
    const Image<float> first = seen(mesh, pixels, light, a), second = seen(mesh, pixels, light, b);
    int count = 0;
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 40; ++x) count += first(x, y) != second(x, y);
    }
    return count;
  };
  const RaySettings settings{.rays = 16, .reach_mm = kReachMm, .seed = 5, .stream = 1};
  RaySettings other_seed = settings, other_led = settings;
  other_seed.seed = 6;
  other_led.stream = 2;
  EXPECT_EQ(differing(settings, settings), 0);
  EXPECT_GT(differing(settings, other_seed), 20);
  EXPECT_GT(differing(settings, other_led), 20);
}

TEST(Shadows, LeaveALampLitThatTouchesTheCloth) {
  const Rect area{0, 0, 8, 8};
  const HeightMesh mesh = bumpy_surface(area).mesh();
  const Vec3 on_cloth = mesh.ray_start_mm(4, 4);
  for (const double radius_mm : {0.0, 1.0}) {
    EXPECT_EQ(seen(mesh, {4, 4, 5, 5}, {on_cloth, radius_mm}, {.rays = 16, .reach_mm = 1})(0, 0), 1);
  }
}

TEST(Shadows, HaveTheStatedErrorAtTheDefaultNumberOfRays) {
  const Rect pixels{0, 0, 40, 40};
  const HeightMesh mesh = bumpy_surface(grown(pixels, 34)).mesh();
  const auto seen_with = [&](int rays, std::uint32_t stream) {
    return seen(mesh, pixels, kLed, {.rays = rays, .reach_mm = kReachMm, .seed = 2, .stream = stream});
  };
  const Image<float> reference = seen_with(64 * kShadowRays, 1), found = seen_with(kShadowRays, 2);
  double squares = 0;
  int in_penumbra = 0;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      if (reference(x, y) == 0 || reference(x, y) == 1) continue;
      squares += std::pow(found(x, y) - reference(x, y), 2.0);
      ++in_penumbra;
    }
  }
  ASSERT_GT(in_penumbra, 20);
  EXPECT_LT(std::sqrt(squares / in_penumbra), 0.06);
}

TEST(Shadows, RefuseSettingsOutOfRange) {
  const Rect area{0, 0, 8, 8};
  const HeightMesh mesh = bumpy_surface(area).mesh();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto why = [&](Rect pixels, const SphereLight& light, const RaySettings& settings) {
    const auto fraction = visible_fraction(mesh, pixels, light, settings);
    if (fraction) return std::string("accepted");
    EXPECT_EQ(fraction.error().kind, ErrorKind::kBadData);
    return fraction.error().why;
  };
  EXPECT_EQ(why(area, kLed, {.rays = 1, .reach_mm = 1}), "accepted");
  EXPECT_EQ(why(area, kLed, {.rays = 0, .reach_mm = 1}), "0 rays a pixel");
  EXPECT_EQ(why(area, kLed, {.rays = 1, .reach_mm = 0}), "a reach of 0 mm");
  EXPECT_EQ(why(area, kLed, {.rays = 1, .reach_mm = kNan}), "a reach of nan mm");
  EXPECT_THAT(why({0, 0, 9, 8}, kLed, {.rays = 1, .reach_mm = 1}), testing::HasSubstr("[0, 9) x [0, 8)"));
  for (const SphereLight& light : {SphereLight{{kNan, 0, 1}, 0}, SphereLight{{0, 0, 1}, -1}}) {
    EXPECT_THAT(why(area, light, {.rays = 1, .reach_mm = 1}), testing::HasSubstr("not finite"));
  }
}

}  // namespace
}  // namespace weft::simulator
