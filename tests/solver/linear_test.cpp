// SPDX-License-Identifier: Apache-2.0
#include "solver/kernels/linear.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bench/oracles/oracle_rig.h"
#include "solver/in_double/pixel.h"
#include "tests/simd_targets.h"
#include "tests/solver/tiles.h"

namespace weft {
namespace {

using test::cloth;
using test::cloth_field;
using test::kClothTile;
using test::kInfinity;
using test::kNaN;
using test::on_every_target;
using test::Random;
using test::Trial;
using test::Truth;

double worst_error_deg(const Trial& trial) {
  double worst = 0;
  for (int y = 0; y < kClothTile.height(); ++y) {
    for (int x = 0; x < kClothTile.width(); ++x) worst = std::max(worst, trial.error_deg(x, y));
  }
  return worst;
}

TEST(Fast, RecoversEveryNormalFromMosaicAndRgbOnEveryTarget) {
  const LightField field = cloth_field(test::ten_leds());
  on_every_target([&] {
    for (const int planes : {1, 3}) {
      Trial trial(field, kClothTile, planes, cloth(50));
      trial.solve(*solver::fast_method());
      EXPECT_LT(worst_error_deg(trial), 1e-3) << planes << " planes";
    }
  });
}

TEST(LeastSquares, RecoversEveryNormalThatAllLightsReach) {
  const LightField field = cloth_field(test::ten_leds());
  on_every_target([&] {
    for (const int planes : {1, 3}) {
      Trial trial(field, kClothTile, planes, cloth(18));
      trial.solve(*solver::least_squares_method());
      EXPECT_LT(worst_error_deg(trial), 1e-3) << planes << " planes";
    }
  });
}

TEST(Fast, HandlesAnyLobeAndGain) {
  for (const double mu : {0.0, 0.5, 1.0, 2.3}) {
    NearLights lights = test::ten_leds(mu);
    for (std::size_t c = 0; c < 3; ++c) {
      lights.log_gain_rgb[c] = {6, 4, {}};
      Random random(c);
      for (int i = 0; i < 24; ++i)
        lights.log_gain_rgb[c].coefficients.push_back(0.3 * random.uniform() - 0.15);
    }
    lights.leds[4].log_gain_quadratic = {0.01, -0.02, 0.03, 0.01, 0.02, -0.01};
    const LightField field = cloth_field(lights);
    on_every_target([&] {
      for (const int planes : {1, 3}) {
        Trial trial(field, kClothTile, planes, cloth(50));
        trial.solve(*solver::fast_method());
        EXPECT_LT(worst_error_deg(trial), 1e-3) << "mu " << mu << ", " << planes << " planes";
      }
    });
  }
}

TEST(Fast, KeepsAbsoluteAlbedo) {
  const LightField field = cloth_field(test::ten_leds());
  Trial trial(field, kClothTile, 3, cloth(50));
  trial.solve(*solver::fast_method());
  for (int x = 0; x < kClothTile.width(); ++x) {
    for (int c = 0; c < 3; ++c) {
      const double truth = cloth(50)(x, 2).albedo[static_cast<std::size_t>(c)];
      EXPECT_NEAR(trial.albedo(x, 2, c) / truth, 1, 1e-5) << x << ' ' << c;
    }
  }
}

// Everything a method returns, next to the double-precision reference of the same pixel.
void expect_as_reference(const LightField& field, int planes, bool mask,
                         const std::optional<NoiseModel>& noise) {
  Trial trial(field, kClothTile, planes, cloth(70));
  trial.add_noise({2e-4, 1e-7, noise ? 1e-7 : 0}, 7);
  Random random(3);
  for (int i = 0; i < 400; ++i) {
    const auto light = static_cast<std::size_t>(random.uniform() * 10);
    const int x = static_cast<int>(random.uniform() * kClothTile.width()),
              y = static_cast<int>(random.uniform() * 5);
    trial.reading(light)(x, y) = i % 2 == 0 ? kInfinity : kNaN;
  }
  trial.solve(mask ? *solver::fast_method() : *solver::least_squares_method(), noise);
  std::vector<solver::PixelRow> rows(field.count());
  for (int y = 0; y < kClothTile.height(); ++y) {
    for (int x = 0; x < kClothTile.width(); ++x) {
      for (std::size_t k = 0; k < rows.size(); ++k) {
        for (int p = 0; p < planes; ++p) {
          const int px = kClothTile.x0 + x, py = kClothTile.y0 + y;
          const LightField::Light light = field.at(k, planes == 1 ? trial.cfa.channel_at(px, py) : p, px, py);
          rows[k].direction = light.direction;
          rows[k].strength[static_cast<std::size_t>(p)] = light.strength;
          rows[k].reading[static_cast<std::size_t>(p)] = trial.reading(k, p)(x, y);
        }
      }
      const solver::PixelSolution truth = solver::solve_pixel(rows, {planes, mask, noise});
      SCOPED_TRACE(testing::Message() << "pixel " << x << ", " << y);
      ASSERT_LT(angle_deg(trial.normal(x, y), truth.normal), 2e-3);
      ASSERT_EQ(trial.status(x, y), truth.status);
      ASSERT_NEAR(trial.sigma_normal_deg(x, y), truth.sigma_normal_deg, 2e-3 * truth.sigma_normal_deg + 1e-3);
      ASSERT_NEAR(trial.residual(x, y), truth.residual, 2e-3 * truth.residual + 1e-5);
      for (int p = 0; p < planes; ++p) {
        const auto c = static_cast<std::size_t>(p);
        ASSERT_NEAR(trial.albedo(x, y, p), truth.albedo[c], 1e-4);
        ASSERT_NEAR(trial.sigma_albedo(x, y, p), truth.sigma_albedo[c], 2e-3 * truth.sigma_albedo[c] + 1e-5);
      }
    }
  }
}

TEST(LinearKernel, AgreesWithItsReferenceOnEveryTarget) {
  const LightField field = cloth_field(test::ten_leds());
  on_every_target([&] {
    for (const bool mask : {false, true}) {
      expect_as_reference(field, 1, mask, NoiseModel{2e-4, 1e-7, 1e-7});
      expect_as_reference(field, 1, mask, std::nullopt);
      expect_as_reference(field, 3, mask, std::nullopt);
    }
  });
}

TEST(LinearKernel, GivesTheSameBytesWhereverTheTileBegins) {
  const LightField field = cloth_field(test::ten_leds());
  const auto truth = [](int x, int y) { return cloth(50)(x + 64, y + 1); };
  Trial whole(field, {0, 0, 259, 3}, 1, cloth(50));
  Trial part(field, {64, 1, 131, 3}, 1, truth);
  whole.solve(*solver::fast_method());
  part.solve(*solver::fast_method());
  for (int x = 0; x < 67; ++x) {
    EXPECT_EQ(whole.normals(x + 64, 1, 0), part.normals(x, 0, 0)) << x;
    EXPECT_EQ(whole.albedo(x + 64, 2), part.albedo(x, 1)) << x;
  }
}

TEST(LinearKernel, GivesTheSameBitsWhateverThePixelBeside) {
  const LightField field = cloth_field(test::ten_leds());
  const NoiseModel noise = {2e-4, 1e-7, 1e-7};
  on_every_target([&] {
    for (const int planes : {1, 3}) {
      Trial alone(field, kClothTile, planes, cloth(15)), beside(field, kClothTile, planes, cloth(15));
      for (int x = 0; x < kClothTile.width(); x += 7) beside.reading(3)(x, 0) = x % 2 == 0 ? kNaN : 0;
      alone.solve(*solver::fast_method(), noise);
      beside.solve(*solver::fast_method(), noise);
      for (int x = 0; x < kClothTile.width(); ++x) {
        if (x % 7 == 0) continue;
        ASSERT_EQ(alone.normal(x, 0), beside.normal(x, 0)) << planes << " planes, pixel " << x;
        ASSERT_EQ(alone.sigma_normal_deg(x, 0), beside.sigma_normal_deg(x, 0))
            << planes << " planes, pixel " << x;
        ASSERT_EQ(alone.sigma_albedo(x, 0), beside.sigma_albedo(x, 0)) << planes << " planes, pixel " << x;
        ASSERT_EQ(alone.residual(x, 0), beside.residual(x, 0)) << planes << " planes, pixel " << x;
        ASSERT_EQ(alone.status(x, 0), beside.status(x, 0)) << planes << " planes, pixel " << x;
      }
    }
  });
}

TEST(LinearKernel, SaysWhyAPixelHasNoSolution) {
  const LightField field = cloth_field(test::ten_leds());
  Trial trial(field, kClothTile, 1, [](int, int) { return Truth{{0, 0, 1}, {0.5, 0.5, 0.5}}; });
  for (std::size_t k = 0; k < 10; ++k) {
    trial.reading(k)(0, 0) = kNaN;
    trial.reading(k)(1, 0) = kInfinity;
    if (k >= 2) trial.reading(k)(2, 0) = kInfinity;
    if (k >= 3) trial.reading(k)(3, 0) = kNaN;
    trial.reading(k)(4, 0) = 0;
    trial.reading(k)(5, 0) = -kInfinity;
    trial.reading(k)(6, 0) = 1e-38f;
    trial.reading(k)(7, 0) = std::numeric_limits<float>::max();
  }
  trial.solve(*solver::fast_method(), NoiseModel{1e-4, 1e-8, 0});
  EXPECT_EQ(trial.status(0, 0), kInvalidReading | kNoSolution);
  EXPECT_EQ(trial.status(1, 0), kSaturated | kNoSolution);
  EXPECT_EQ(trial.status(2, 0), kSaturated | kNoSolution);
  EXPECT_NEAR(trial.albedo(2, 0), 0.5, 1e-5) << "two readings still give the albedo of a flat cloth";
  EXPECT_EQ(trial.status(3, 0), kInvalidReading | kZeroDof);
  EXPECT_LT(trial.error_deg(3, 0), 1e-3);
  EXPECT_EQ(trial.status(4, 0), kDark | kNoSolution);
  EXPECT_EQ(trial.status(5, 0), kShadowed | kNoSolution);
  EXPECT_TRUE(trial.status(6, 0) & kDark);
  for (int x = 0; x < 8; ++x) {
    EXPECT_NEAR(length(trial.normal(x, 0)), 1, 1e-6) << x;
    EXPECT_TRUE(std::isfinite(trial.albedo(x, 0))) << x;
    EXPECT_TRUE(std::isfinite(trial.sigma_normal_deg(x, 0))) << x;
    EXPECT_TRUE(std::isfinite(trial.residual(x, 0))) << x;
    EXPECT_TRUE(std::isfinite(trial.sigma_albedo(x, 0))) << x;
    if (trial.status(x, 0) & kNoSolution) {
      EXPECT_EQ(trial.normal(x, 0), (Vec3{0, 0, 1})) << x;
      EXPECT_EQ(trial.sigma_normal_deg(x, 0), solver::kUnknownAngleDeg) << x;
    }
  }
}

TEST(Fast, LeavesOutAttachedShadowWhereLeastSquaresIsBent) {
  const LightField field = cloth_field(test::ten_leds());
  const Vec3 steep = normalized({std::sin(radians(50)), 0, std::cos(radians(50))});
  const auto truth = [&](int, int) { return Truth{steep, {0.5, 0.5, 0.5}}; };
  Trial plain(field, kClothTile, 1, truth), masked(field, kClothTile, 1, truth);
  plain.solve(*solver::least_squares_method());
  masked.solve(*solver::fast_method());
  EXPECT_GT(plain.error_deg(60, 2), 3);
  EXPECT_LT(masked.error_deg(60, 2), 1e-3);
  EXPECT_TRUE(masked.status(60, 2) & kShadowed);
}

TEST(Fast, FlagsAHighlight) {
  const LightField field = cloth_field(test::ten_leds());
  Trial trial(field, kClothTile, 1, [](int, int) { return Truth{{0, 0, 1}, {0.05, 0.05, 0.05}}; });
  trial.reading(2)(9, 1) *= 30;
  trial.solve(*solver::fast_method());
  EXPECT_TRUE(trial.status(9, 1) & kSpecular);
  EXPECT_FALSE(trial.status(10, 1) & kSpecular);
}

TEST(LeastSquares, PredictsItsOwnScatter) {
  const LightField field = cloth_field(test::ten_leds());
  const Vec3 n = normalized({0.1, 0.05, 1});
  const NoiseModel noise = {5e-5, 1e-8, 4e-8};
  const Rect tile = {256, 200, 256 + 256, 200 + 80};
  Trial trial(field, tile, 1, [&](int, int) { return Truth{n, {0.3, 0.3, 0.3}}; });
  trial.add_noise(noise, 11);
  trial.solve(*solver::least_squares_method(), noise);
  double square = 0, predicted = 0, rho_square = 0, rho_predicted = 0;
  for (int y = 0; y < tile.height(); ++y) {
    for (int x = 0; x < tile.width(); ++x) {
      square += std::pow(trial.error_deg(x, y), 2);
      predicted += std::pow(trial.sigma_normal_deg(x, y), 2);
      rho_square += std::pow(trial.albedo(x, y) - 0.3, 2);
      rho_predicted += std::pow(trial.sigma_albedo(x, y), 2);
    }
  }
  EXPECT_NEAR(std::sqrt(square / predicted), 1, 0.02);
  EXPECT_NEAR(std::sqrt(rho_square / rho_predicted), 1, 0.02);
}

TEST(Bare, SolvesTheSameEquations) {
  const LightField field = cloth_field(test::ten_leds(0));
  const Rect tile = {0, 0, 640, 4};
  Image<float> readings({640, 4}, 30), normal({640, 4}, 3), albedo({640, 4}, 3);
  std::vector<View<const float>> views;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 640; ++x) {
      for (int i = 0; i < 30; ++i) {
        const LightField::Light light = field.at(static_cast<std::size_t>(i / 3), i % 3, x, y);
        readings(x, y, i) =
            static_cast<float>(0.4 * light.strength * dot(cloth(25)(x, y).normal, light.direction));
      }
    }
  }
  for (int i = 0; i < 30; ++i) views.push_back(readings.plane(i));
  on_every_target([&] {
    solver::solve_bare(tile, views, field, {normal.plane(0), normal.plane(1), normal.plane(2)},
                       {albedo.plane(0), albedo.plane(1), albedo.plane(2)});
    for (int x = 0; x < 640; ++x) {
      const Vec3 n = {normal(x, 3, 0), normal(x, 3, 1), normal(x, 3, 2)};
      ASSERT_LT(angle_deg(n, cloth(25)(x, 3).normal), 1e-3) << x;
      ASSERT_NEAR(albedo(x, 3, 1), 0.4, 1e-5) << x;
    }
  });
}

}  // namespace
}  // namespace weft
