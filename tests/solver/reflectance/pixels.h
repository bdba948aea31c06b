// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "bench/oracles/oracle_rig.h"
#include "core/base/vec.h"
#include "solver/reflectance/lobe_fit.h"

// Pixels of a cloth in closed form, under four lights at 35 degrees from the zenith and six at 62.

namespace weft::solver {

using test::Random;
using test::random_normal;

inline std::vector<Vec3> ten_directions() {
  std::vector<Vec3> lights;
  for (int k = 0; k < 10; ++k) {
    const double zenith = radians(k < 4 ? 35 : 62);
    const double azimuth = radians(k < 4 ? 90.0 * k : 60.0 * (k - 4) + 15);
    lights.push_back(
        {std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)});
  }
  return lights;
}

/// What the readings of a pixel are: by its normal, albedo, yarn and one light from straight above.
using PixelModel = std::function<double(Vec3 normal, double albedo, double yarn, const LitFrom& from)>;

inline PixelModel model_of(const Lobe& lobe) {
  return [lobe](Vec3 n, double albedo, double yarn, const LitFrom& from) {
    return modelled(lobe, albedo * n, from, yarn);
  };
}

struct ClothOfPixels {
  double tilt_deg = 25;  ///< most of the normals
  double albedo = 0.4;
  double noise = 0.003;         ///< of a reading, a share of it
  bool has_both_yarns = false;  ///< every third pixel is weft
};

struct PixelTruth {
  LobeSamples samples{10};
  std::vector<Vec3> b;      ///< true
  std::vector<Vec3> start;  ///< what least squares by Lambert's law makes of the readings
  std::vector<double> yarn;
};

/// A reading of `bare` with noise, as the light is thought to come.
inline LobeReading reading_of(double bare, const LitFrom& from, double noise, Random& random) {
  const double x = bare * (1 + noise * random.normal());
  const double sigma2 = std::pow(noise * x, 2) + std::pow(kLobeModelShare * std::max(x, kLeastModelled), 2);
  return {from, x, x > 0 ? 1 / sigma2 : 0};
}

inline std::vector<LobeReading> readings_of(const PixelModel& model, Vec3 n, double albedo, double yarn,
                                            double noise, Random& random) {
  std::vector<LobeReading> readings;
  for (const Vec3& l : ten_directions()) {
    const LitFrom from(l, {0, 0, 1});
    readings.push_back(reading_of(model(n, albedo, yarn, from), from, noise, random));
  }
  return readings;
}

/// Through crossed films, and then through parallel ones.
inline std::vector<LobeReading> pair_of_readings(const Lobe& lobe, Vec3 n, double albedo, double noise,
                                                 Random& random, double leak = 0.01) {
  std::vector<LobeReading> readings;
  for (const double share : {2 * leak, 2.0}) {
    for (const Vec3& l : ten_directions()) {
      const LitFrom from(l, {0, 0, 1}, share);
      readings.push_back(reading_of(modelled(lobe, albedo * n, from, 0), from, noise, random));
    }
  }
  return readings;
}

inline Vec3 lambert_fit(std::span<const LobeReading> readings) {
  PixelSystem system;
  for (const LobeReading& r : readings) system.add(r.from.light, 1, r.x);
  system.regularise();
  return system.solved(system.gradient);
}

/// What the readings of a pixel are: ten of each state of films.
using PixelReadings =
    std::function<std::vector<LobeReading>(Vec3 normal, double albedo, double yarn, Random& random)>;

inline PixelTruth pixels_by(const PixelReadings& readings_of_pixel, std::size_t count,
                            const ClothOfPixels& cloth, std::uint64_t seed, std::size_t states = 1) {
  PixelTruth truth;
  truth.samples = LobeSamples(10, states);
  Random random(seed);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 n = random_normal(random, cloth.tilt_deg);
    const double albedo = cloth.albedo * (0.9 + 0.2 * random.uniform());
    const double yarn = cloth.has_both_yarns && i % 3 == 0 ? kPi / 2 : 0;
    const auto readings = readings_of_pixel(n, albedo, yarn, random);
    truth.samples.add(readings);
    truth.b.push_back(albedo * n);
    truth.yarn.push_back(yarn);
    truth.start.push_back(lambert_fit(std::span(readings).first(10)));
  }
  return truth;
}

inline PixelTruth pixels_of(const PixelModel& model, std::size_t count, const ClothOfPixels& cloth,
                            std::uint64_t seed) {
  return pixels_by([&](Vec3 n, double albedo, double yarn,
                       Random& random) { return readings_of(model, n, albedo, yarn, cloth.noise, random); },
                   count, cloth, seed);
}

inline double mean_angle_deg(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += angle_deg(a[i], b[i]);
  return sum / static_cast<double>(a.size());
}

}  // namespace weft::solver
