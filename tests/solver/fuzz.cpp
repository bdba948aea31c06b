// SPDX-License-Identifier: Apache-2.0
#include "tests/solver/fuzz.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "bench/oracles/hard_lights.h"
#include "bench/oracles/oracle_rig.h"

namespace weft::test {
namespace {

const Size kSize = {128, 16};
const Rect kTile = {0, 0, 128, 16};

double between(Random& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

Vec3 any_direction(Random& random) {
  const double z = between(random, -0.2, 1), azimuth = between(random, 0, 2 * kPi);
  const double s = std::sqrt(1 - z * z);
  return {s * std::cos(azimuth), s * std::sin(azimuth), z};
}

// Lights that LightField accepts: distant or near, closing up or not, thirty decades of strength.
LightField any_field(Random& random) {
  for (;;) {
    const auto count = static_cast<std::size_t>(between(random, 3, 13));
    const double spread = std::pow(10, between(random, -6, 0)), decades = between(random, 0, 30);
    const Vec3 middle = any_direction(random);
    DistantLights distant;
    NearLights near;
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3 l = normalized(middle + spread * any_direction(random));
      const double strength = std::pow(10, between(random, -decades, decades));
      distant.lights.push_back({l, {strength, 2 * strength, 0.7 * strength}});
      NearLight led;
      led.position_mm = between(random, 2, 900) * Vec3{l.x, l.y, std::abs(l.z)};
      led.aim = normalized(Vec3{0, 0, -1} + any_direction(random));
      led.mu = between(random, 0, 4);
      led.flux_rgb = {1e5 * strength, 2e5 * strength, 7e4 * strength};
      near.leds.push_back(led);
    }
    const Lights lights = random.uniform() < 0.5 ? Lights(distant) : Lights(near);
    Result<LightField> field =
        LightField::make(lights, overhead_camera(kSize, 600, std::pow(10, between(random, -3, 0))), kSize, 0);
    if (field) return std::move(*field);
  }
}

float any_reading(Random& random, float sensible) {
  using Limits = std::numeric_limits<float>;
  const auto bits = static_cast<std::uint32_t>(random.uniform() * 0x1p32);
  switch (static_cast<int>(random.uniform() * 12)) {
    case 0:
      return std::bit_cast<float>(bits);
    case 1:
      return Limits::quiet_NaN();
    case 2:
      return Limits::infinity();
    case 3:
      return -Limits::infinity();
    case 4:
      return 0;
    case 5:
      return -sensible;
    case 6:
      return Limits::denorm_min() * static_cast<float>(bits % 1000);
    case 7:
      return bits % 2 == 0 ? Limits::max() : Limits::lowest();
    default:
      return sensible;
  }
}

// Spoils each pixel in a manner of its own, from one reading in twelve to all of them.
void spoil(Trial& trial, std::size_t lights, int planes, Random& random) {
  for (int y = 0; y < kTile.height(); ++y) {
    for (int x = 0; x < kTile.width(); ++x) {
      const double share = random.uniform();
      const bool alike = random.uniform() < 0.1;
      const float other = any_reading(random, 1);
      for (std::size_t k = 0; k < lights; ++k) {
        for (int p = 0; p < planes; ++p) {
          float& r = trial.reading(k, p)(x, y);
          if (alike) {
            r = other;
          } else if (random.uniform() < share * share) {
            r = any_reading(random, r);
          }
        }
      }
    }
  }
}

bool within(float v, double most) {
  return v >= 0 && v <= most;  // false for NaN
}

// What is wrong with a pixel; empty where nothing is.
std::string fault_of(const Trial& trial, int planes, int x, int y) {
  const Vec3 n = trial.normal(x, y);
  const float sigma = trial.sigma_normal_deg(x, y), residual = trial.residual(x, y);
  const int status = trial.status(x, y);
  if (!(std::abs(length(n) - 1) <= 1e-6)) return fmt::format("normal ({}, {}, {})", n.x, n.y, n.z);
  if (!within(sigma, 180)) return fmt::format("sigma of {} degrees", sigma);
  if (!within(residual, std::numeric_limits<float>::max())) return fmt::format("residual {}", residual);
  for (int p = 0; p < planes; ++p) {
    const float rho = trial.albedo(x, y, p), s = trial.sigma_albedo(x, y, p);
    if (!within(rho, std::numeric_limits<float>::max())) return fmt::format("albedo {}", rho);
    if (!within(s, std::numeric_limits<float>::max())) return fmt::format("sigma of the albedo {}", s);
  }
  if (status > 0xff) return "a status bit without a name";
  const bool none = (status & kNoSolution) != 0;
  if (none && (n != Vec3{0, 0, 1} || sigma != 180)) return "NO_SOLUTION with a normal or a sigma";
  if (none && (status & (kZeroDof | kIllConditioned | kSpecular)) != 0)
    return "NO_SOLUTION with a bit that speaks of a solution";
  return {};
}

std::string described(const Trial& trial, int planes, int x, int y) {
  std::string text;
  for (const solver::PixelRow& row : trial.rows(x, y)) {
    text += fmt::format("\n  l {} {} {}", row.direction.x, row.direction.y, row.direction.z);
    for (std::size_t p = 0; p < static_cast<std::size_t>(planes); ++p)
      text += fmt::format("  e {} r {}", row.strength[p], row.reading[p]);
  }
  return text;
}

}  // namespace

void expect_sound_from_rubbish(std::int64_t pixels, std::uint64_t seed) {
  std::int64_t done = 0;
  for (std::uint64_t round = seed; done < pixels; ++round) {
    for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
      Random random(round * 0x9e3779b97f4a7c15u);
      const LightField field = any_field(random);
      Trial trial(field, kTile, planes, [&](int, int) {
        return Truth{random_normal(random, 89), {random.uniform(), random.uniform(), random.uniform()}};
      });
      spoil(trial, field.count(), planes, random);
      std::optional<NoiseModel> noise;
      if (random.uniform() < 0.7) {
        const double scale = std::pow(10, between(random, -20, 4));
        noise = NoiseModel{scale * random.uniform(), scale * scale * random.uniform(),
                           random.uniform() < 0.5 ? 0 : scale * scale * random.uniform()};
      }
      trial.solve(method, planes == 1 ? noise : std::nullopt);
      for (int y = 0; y < kTile.height(); ++y) {
        for (int x = 0; x < kTile.width(); ++x) {
          const std::string fault = fault_of(trial, planes, x, y);
          if (fault.empty()) continue;
          ADD_FAILURE() << name << ", " << planes << " planes, round " << round << ", pixel " << x << ", "
                        << y << ": " << fault << ", status " << trial.status(x, y)
                        << (noise ? fmt::format(", noise {} {} {}", noise->per_reading, noise->floor,
                                                noise->shared)
                                  : std::string())
                        << described(trial, planes, x, y);
          return;
        }
      }
      done += kTile.pixels();
    });
    if (testing::Test::HasFailure()) return;
  }
}

}  // namespace weft::test
