// SPDX-License-Identifier: Apache-2.0
// Readings that are hard to solve from, each case by its number in docs/numerics.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "bench/oracles/hard_lights.h"
#include "bench/oracles/oracle_rig.h"
#include "bench/oracles/quad_oracle.h"
#include "core/image/tiles.h"
#include "solver/in_double/pixel.h"
#include "tests/solver/tiles.h"

namespace weft {
namespace {

using test::hard_field;
using test::kHardSize;
using test::kHardTile;
using test::kInfinity;
using test::kNaN;
using test::oracle_of;
using test::OracleSolution;
using test::Random;
using test::Trial;
using test::Truth;

// Distant lights at the places of the ten LEDs.
DistantLights ten_distant() {
  DistantLights lights;
  for (const NearLight& led : test::ten_leds().leds)
    lights.lights.push_back({normalized(led.position_mm), {1, 1, 1}});
  return lights;
}

std::function<Truth(int, int)> even_cloth(double most_deg) {
  return [most_deg](int x, int y) {
    Random random(static_cast<std::uint64_t>(y) * 1000 + static_cast<std::uint64_t>(x));
    return Truth{test::random_normal(random, most_deg), {0.3, 0.5, 0.2}};
  };
}

void expect_sound(const Trial& trial, int planes, int x, int y) {
  ASSERT_NEAR(length(trial.normal(x, y)), 1, 1e-6) << x << ", " << y;
  ASSERT_TRUE(trial.sigma_normal_deg(x, y) >= 0 && trial.sigma_normal_deg(x, y) <= 180) << x << ", " << y;
  ASSERT_TRUE(std::isfinite(trial.residual(x, y))) << x << ", " << y;
  for (int p = 0; p < planes; ++p) {
    ASSERT_TRUE(trial.albedo(x, y, p) >= 0 && std::isfinite(trial.albedo(x, y, p))) << x << ", " << y;
    ASSERT_TRUE(trial.sigma_albedo(x, y, p) >= 0 && std::isfinite(trial.sigma_albedo(x, y, p)))
        << x << ", " << y;
  }
}

TEST(HardCase05AllInShadow, IsDarkWithAnAlbedoOfZeroWithinItsSigma) {
  const LightField field = hard_field(test::ten_leds());
  const NoiseModel noise = {0, 1e-6, 0};
  test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
    if (planes == 3) return;
    SCOPED_TRACE(name);
    Trial trial(field, kHardTile, planes, even_cloth(20));
    Random random(9);
    for (int x = 0; x < kHardTile.width(); ++x) {
      for (std::size_t k = 0; k < field.count(); ++k) {
        trial.reading(k)(x, 0) = 0;
        trial.reading(k)(x, 1) = static_cast<float>(1e-3 * std::clamp(random.normal(), -2.9, 2.9));
      }
    }
    trial.solve(method, noise);
    for (int x = 0; x < kHardTile.width(); ++x) {
      ASSERT_EQ(trial.status(x, 0), kDark | kNoSolution) << x;
      ASSERT_EQ(trial.albedo(x, 0), 0) << x;
      ASSERT_EQ(trial.status(x, 1) & ~(kShadowed | kZeroDof), kDark) << x;
      ASSERT_LT(trial.albedo(x, 1), 6 * trial.sigma_albedo(x, 1)) << x;
      expect_sound(trial, planes, x, 0);
      expect_sound(trial, planes, x, 1);
    }
  });
}

TEST(HardCase06SaturatedReadings, AreLeftOutBeforeAnythingElse) {
  const LightField field = hard_field(ten_distant());
  test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
    SCOPED_TRACE(testing::Message() << name << ", " << planes << " planes");
    Trial trial(field, kHardTile, planes, even_cloth(15));
    // One more light is saturated from pixel to pixel, each in one channel.
    for (int x = 0; x < kHardTile.width(); ++x) {
      for (int k = 0; k < x % 11; ++k)
        trial.reading(static_cast<std::size_t>((k * 3 + x) % 10), k % planes)(x, 0) = kInfinity;
    }
    trial.solve(method);
    for (int x = 0; x < kHardTile.width(); ++x) {
      const int left = 10 - x % 11;
      const int expected =
          (left < 10 ? kSaturated : 0) | (left == 3 ? kZeroDof : 0) | (left < 3 ? kNoSolution : 0);
      ASSERT_EQ(trial.status(x, 0), expected) << x;
      if (left < 3) continue;
      const OracleSolution exact = oracle_of(trial, planes, x, 0);
      ASSERT_LT(angle_deg(trial.normal(x, 0), exact.normal), exact.condition <= 3 ? 1e-4 : 5e-3)
          << x << ", condition " << exact.condition;
    }
  });
}

TEST(HardCase07ZeroAlbedo, GivesSoundValuesAndSaysHowLittleTheyMean) {
  const LightField field = hard_field(ten_distant());
  const NoiseModel noise = {1e-5, 1e-6, 0};
  test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
    SCOPED_TRACE(testing::Message() << name << ", " << planes << " planes");
    Trial trial(field, kHardTile, planes, [](int, int) { return Truth{{0, 0, 1}, {0, 0, 0}}; });
    trial.add_noise(noise, 3);
    trial.solve(method, planes == 1 ? std::optional(noise) : std::nullopt);
    int sure = 0;
    for (int y = 0; y < kHardTile.height(); ++y) {
      for (int x = 0; x < kHardTile.width(); ++x) {
        expect_sound(trial, planes, x, y);
        sure += planes == 1 && trial.sigma_normal_deg(x, y) < 15;  // RGB knows no noise but its own scatter
      }
    }
    EXPECT_LT(sure, kHardTile.pixels() / 10) << "of " << kHardTile.pixels();
  });
}

// E|b|^2 = |b_true|^2 + tr C: the bias of a dark albedo is the one that its covariance predicts.
TEST(HardCase07ZeroAlbedo, HasABiasThatItsCovariancePredicts) {
  const DistantLights lights = ten_distant();
  const LightField field = hard_field(lights);
  const NoiseModel noise = {0, 1e-6, 0};
  const Rect tile = {0, 0, 256, 16};
  Trial trial(field, tile, 1, [](int, int) { return Truth{{0, 0, 1}, {0, 0, 0}}; });
  trial.add_noise(noise, 17);
  trial.solve(*solver::least_squares_method(), noise);
  double mean_square = 0;
  for (int y = 0; y < tile.height(); ++y) {
    for (int x = 0; x < tile.width(); ++x) mean_square += std::pow(trial.albedo(x, y), 2) / 4096;
  }
  // tr G^-1 from the variances of three exact unit solutions: one direction's share after the other.
  double trace = 0;
  for (const Vec3 unit : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    std::vector<test::OracleRow> rows;
    for (std::size_t k = 0; k < 10; ++k) rows.push_back({lights.lights[k].direction, 1, 0});
    for (std::size_t k = 0; k < 10; ++k) {
      rows[k].reading = 1;  // row k of the pseudo-inverse
      const OracleSolution column = test::solve_in_quad(rows);
      trace += std::pow(column.albedo * dot(column.normal, unit), 2);
      rows[k].reading = 0;
    }
  }
  // The mean of 4096 sums of three squares has a standard deviation near 1.3 percent.
  EXPECT_NEAR(mean_square / (noise.floor * trace), 1, 0.05);
}

TEST(HardCase08DynamicRange, TwelveDecadesOfIntensityLeaveNoTrace) {
  DistantLights lights = ten_distant();
  for (std::size_t k = 0; k < 10; ++k)
    lights.lights[k].irradiance_rgb.fill(std::pow(10, -6 + 12.0 * static_cast<double>((k * 7) % 10) / 9));
  const LightField field = hard_field(lights);
  test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
    SCOPED_TRACE(testing::Message() << name << ", " << planes << " planes");
    Trial trial(field, kHardTile, planes, even_cloth(15));
    trial.solve(method);
    for (int x = 0; x < kHardTile.width(); ++x) {
      ASSERT_LT(angle_deg(trial.normal(x, 0), oracle_of(trial, planes, x, 0).normal), 1e-4) << x;
      ASSERT_EQ(trial.status(x, 0), 0) << x;
    }
  });
}

TEST(HardCase08DynamicRange, TwelveDecadesOfAlbedoLeaveNoTrace) {
  const LightField field = hard_field(ten_distant());
  const auto albedo_of = [](int x) { return std::pow(10, -6 + 12.0 * x / 130); };
  const auto truth = [&](int x, int y) {
    const double a = albedo_of(x);
    return Truth{even_cloth(15)(x, y).normal, {a, a, a}};
  };
  test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
    SCOPED_TRACE(testing::Message() << name << ", " << planes << " planes");
    Trial trial(field, kHardTile, planes, truth);
    trial.solve(method);
    for (int x = 0; x < kHardTile.width(); ++x) {
      ASSERT_LT(angle_deg(trial.normal(x, 0), oracle_of(trial, planes, x, 0).normal), 1e-4) << x;
      ASSERT_NEAR(trial.albedo(x, 0) / albedo_of(x), 1, 1e-5) << x;
      ASSERT_EQ(trial.status(x, 0), 0) << x;
    }
  });
}

TEST(HardCase09StrangeReadings, AreCountedOutOrKeptAsTheyDeserve) {
  const LightField field = hard_field(ten_distant());
  const std::vector<std::pair<float, int>> kinds = {
      {kNaN, kInvalidReading}, {-kNaN, kInvalidReading}, {kInfinity, kSaturated}, {-kInfinity, kShadowed}};
  test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
    SCOPED_TRACE(testing::Message() << name << ", " << planes << " planes");
    Trial trial(field, kHardTile, planes, even_cloth(15));
    for (int x = 0; x < kHardTile.width(); ++x)
      trial.reading(static_cast<std::size_t>(x % 10), x % planes)(x, 0) =
          kinds[static_cast<std::size_t>(x) % 4].first;
    trial.solve(method);
    for (int x = 0; x < kHardTile.width(); ++x) {
      ASSERT_EQ(trial.status(x, 0), kinds[static_cast<std::size_t>(x) % 4].second) << x;
      ASSERT_LT(angle_deg(trial.normal(x, 0), oracle_of(trial, planes, x, 0).normal), 1e-4) << x;
    }
  });
}

// The mean of dark-subtracted noise is zero only if its lower half is kept.
TEST(HardCase09StrangeReadings, NegativeOnesStayWhereNothingSpeaksAgainstThem) {
  const LightField field = hard_field(ten_distant());
  Trial trial(field, kHardTile, 1, even_cloth(15));
  for (int x = 0; x < kHardTile.width(); ++x) trial.reading(3)(x, 0) = -0.01f;
  trial.solve(*solver::least_squares_method());
  for (int x = 0; x < kHardTile.width(); ++x) {
    ASSERT_EQ(trial.status(x, 0) & kInvalidReading, 0) << x;
    ASSERT_LT(angle_deg(trial.normal(x, 0), oracle_of(trial, 1, x, 0).normal), 1e-4) << x;
  }
}

TEST(HardCase09StrangeReadings, DenormalOnesAreSolvedForWhatTheyAre) {
  const LightField field = hard_field(ten_distant());
  test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
    SCOPED_TRACE(testing::Message() << name << ", " << planes << " planes");
    Trial trial(field, kHardTile, planes, [&](int x, int y) {
      return Truth{even_cloth(15)(x, y).normal, {2e-42, 2e-42, 2e-42}};
    });
    trial.solve(method);
    for (int x = 0; x < kHardTile.width(); ++x) {
      expect_sound(trial, planes, x, 0);
      ASSERT_EQ(trial.status(x, 0) & kNoSolution, 0) << x;
      ASSERT_LT(trial.error_deg(x, 0), 0.2) << x << ": as coarse as the readings themselves";
    }
  });
}

TEST(HardCase10GrazingNormals, AreSolvedWhereThreeLightsSeeThem) {
  // Three rings, the lowest one degree above the table.
  DistantLights lights;
  for (const double zenith_deg : {30.0, 60.0, 89.0}) {
    for (int i = 0; i < 8; ++i) {
      const double azimuth = radians(45.0 * i + zenith_deg), zenith = radians(zenith_deg);
      lights.lights.push_back(
          {{std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)},
           {1, 1, 1}});
    }
  }
  const LightField field = hard_field(lights);
  // From 60 degrees to 95, past the horizon.
  const auto truth = [](int x, int) {
    const double tilt = radians(60 + 35.0 * x / 130), azimuth = 0.7 * x;
    return Truth{{std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)},
                 {0.5, 0.5, 0.5}};
  };
  test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
    SCOPED_TRACE(testing::Message() << name << ", " << planes << " planes");
    Trial told(field, kHardTile, planes, truth), seen(field, kHardTile, planes, truth);
    for (int x = 0; x < kHardTile.width(); ++x) {
      for (std::size_t k = 0; k < field.count(); ++k) {
        if (dot(truth(x, 0).normal, lights.lights[k].direction) > 0) continue;
        for (int p = 0; p < planes; ++p) told.reading(k, p)(x, 0) = -kInfinity;
      }
    }
    told.solve(method);
    seen.solve(method);
    for (int x = 0; x < kHardTile.width(); ++x) {
      ASSERT_EQ(told.status(x, 0) & (kShadowed | kNoSolution | kIllConditioned), kShadowed) << x;
      ASSERT_LT(told.error_deg(x, 0), 1e-3) << "told which lights see it, pixel " << x;
      if (!test::promise_of(name).masks_shadow) continue;
      ASSERT_LT(seen.error_deg(x, 0), 1e-3) << "by itself, pixel " << x;
    }
  });
}

TEST(HardCase11And12OddTiles, GiveTheBytesOfAPaddedRunForAnyThreads) {
  const LightField field = hard_field(test::ten_leds());
  const Rect whole_area = {0, 0, 256, 13};
  test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
    SCOPED_TRACE(testing::Message() << name << ", " << planes << " planes");
    Trial whole(field, whole_area, planes, even_cloth(60));
    whole.add_noise({1e-3, 1e-4, 0}, 3);
    Image<float> maps(kHardSize, 11);
    Image<std::uint16_t> status(kHardSize);
    const auto solve = [&](Rect tile, int) {
      std::vector<View<const float>> views;
      for (std::size_t i = 0; i < field.count(); ++i) {
        for (int p = 0; p < planes; ++p)
          views.emplace_back(View<const float>(whole.reading(i, p)).crop(tile));
      }
      const auto at = [&](int plane) { return maps.plane(plane).crop(tile); };
      method.solve({tile, planes, whole.cfa, views, &field, std::nullopt}, {{at(0), at(1), at(2)},
                                                                            {at(3), at(4), at(5)},
                                                                            at(6),
                                                                            {at(7), at(8), at(9)},
                                                                            at(10),
                                                                            status.plane().crop(tile)});
    };
    whole.solve(method);
    struct Run {
      Size size;
      TileOptions tiles;
    };
    for (const auto& [size, tiles] :
         {Run{{1, 13}, {512, 32, 2}}, Run{{256, 1}, {64, 1, 7}}, Run{{131, 7}, {64, 3, 32}},
          Run{{67, 5}, {1, 1, 3}}, Run{{256, 13}, {128, 2, 1}}}) {
      ASSERT_TRUE(for_each_tile({0, 0, size.width, size.height}, tiles, {}, solve));
      int different = 0;
      for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
          bool same = status(x, y) == whole.status(x, y) && maps(x, y, 6) == whole.sigma_normal_deg(x, y) &&
                      maps(x, y, 10) == whole.residual(x, y);
          for (int p = 0; p < 3; ++p) same &= maps(x, y, p) == whole.normals(x, y, p);
          for (int p = 0; p < planes; ++p) {
            same &= maps(x, y, 3 + p) == whole.albedo(x, y, p) &&
                    maps(x, y, 7 + p) == whole.sigma_albedo(x, y, p);
          }
          different += !same;
        }
      }
      EXPECT_EQ(different, 0) << "pixels of " << size.width << " x " << size.height << " with "
                              << tiles.threads << " threads";
    }
  });
}

TEST(HardCase11And12OddTiles, NoPixelsAreNoWork) {
  for (const Rect nothing : {Rect{0, 0, 0, 0}, Rect{0, 0, 0, 5}, Rect{64, 3, 64, 3}}) {
    EXPECT_TRUE(for_each_tile(nothing, {}, {}, [](Rect, int) { ADD_FAILURE() << "a tile of nothing"; }));
  }
}

TEST(HardCase14Gauge, OfIntensitiesMovesTheAlbedoAlone) {
  test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
    const DistantLights lights = ten_distant();
    const LightField field = hard_field(lights);
    Trial plain(field, kHardTile, planes, even_cloth(15));
    plain.solve(method);
    for (const int power : {-30, -12, -3, 1, 6, 12, 30}) {
      SCOPED_TRACE(testing::Message() << name << ", " << planes << " planes, 10^" << power);
      DistantLights brighter = lights;
      for (DistantLight& light : brighter.lights) light.irradiance_rgb.fill(std::pow(10, power));
      const LightField bright = hard_field(brighter);
      Trial gauged(bright, kHardTile, planes, even_cloth(15));
      for (std::size_t k = 0; k < 10; ++k) {
        for (int p = 0; p < planes; ++p) {
          for (int x = 0; x < kHardTile.width(); ++x) gauged.reading(k, p)(x, 0) = plain.reading(k, p)(x, 0);
        }
      }
      gauged.solve(method);
      for (int x = 0; x < kHardTile.width(); ++x) {
        ASSERT_LT(angle_deg(gauged.normal(x, 0), plain.normal(x, 0)), 5e-5) << x;
        ASSERT_NEAR(gauged.albedo(x, 0) * std::pow(10, power) / plain.albedo(x, 0), 1, 2e-6) << x;
        ASSERT_EQ(gauged.status(x, 0), plain.status(x, 0)) << x;
        std::vector<solver::PixelRow> rows = plain.rows(x, 0), scaled = gauged.rows(x, 0);
        const solver::PixelSolution a = solver::solve_pixel(rows, {planes, true, {}}),
                                    b = solver::solve_pixel(scaled, {planes, true, {}});
        ASSERT_LT(angle_deg(a.normal, b.normal), 1e-10) << x;
      }
    }
  });
}

TEST(HardCase15Rotation, OfTheLightsTurnsTheNormals) {
  // About (1, 2, 3) by 25 degrees (Rodrigues), which keeps all lights above the table.
  const Vec3 axis = normalized({1, 2, 3});
  const auto turned = [&](Vec3 v) {
    const double c = std::cos(radians(25)), s = std::sin(radians(25));
    return c * v + s * cross(axis, v) + (1 - c) * dot(axis, v) * axis;
  };
  const DistantLights lights = ten_distant();
  DistantLights turned_lights = lights;
  for (DistantLight& light : turned_lights.lights) light.direction = turned(light.direction);
  const LightField field = hard_field(lights), turned_field = hard_field(turned_lights);
  test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
    SCOPED_TRACE(testing::Message() << name << ", " << planes << " planes");
    Trial still(field, kHardTile, planes, even_cloth(15)),
        moved(turned_field, kHardTile, planes, even_cloth(15));
    still.add_noise({1e-5, 1e-6, 0}, 21);
    for (std::size_t k = 0; k < 10; ++k) {
      for (int p = 0; p < planes; ++p) {
        for (int x = 0; x < kHardTile.width(); ++x) moved.reading(k, p)(x, 0) = still.reading(k, p)(x, 0);
      }
    }
    still.solve(method);
    moved.solve(method);
    for (int x = 0; x < kHardTile.width(); ++x) {
      ASSERT_LT(angle_deg(moved.normal(x, 0), turned(still.normal(x, 0))), 1e-4) << x;
      ASSERT_EQ(moved.status(x, 0), still.status(x, 0)) << x;
      for (const solver::Estimator estimator :
           {solver::Estimator::kLeastSquares, solver::Estimator::kRejecting}) {
        const solver::PixelSolution a = solver::solve_pixel(still.rows(x, 0), {planes, true, {}, estimator}),
                                    b = solver::solve_pixel(moved.rows(x, 0), {planes, true, {}, estimator});
        ASSERT_LT(angle_deg(b.normal, turned(a.normal)), 1e-10) << x;
      }
    }
  });
}

}  // namespace
}  // namespace weft
