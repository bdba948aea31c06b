// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "simulator/reflectance/reflectance.h"
#include "solver/reflectance/lobe_tint.h"
#include "solver/reflectance/materials.h"
#include "tests/solver/reflectance/lights_off.h"

// Pixels whose highlights have a colour, as the simulator's own models reflect, under a rig that is not quite
// what its calibration says.

namespace weft::solver {

using simulator::AnisotropicGgx;
using simulator::Beneath;
using simulator::Ggx;
using simulator::Reflectance;

inline constexpr Rgb kGold = {0.1, 0.08, 0.04}, kWhite = {0.05, 0.05, 0.05};
inline constexpr Rgb kDarkYarn = {0.06, 0.05, 0.03}, kRed = {0.5, 0.12, 0.04};

inline Reflectance ggx(const Rgb& f0, double alpha = 0.3) {
  return Ggx{.alpha = alpha, .f0 = f0, .beneath = Beneath::kBalanced};
}
inline Reflectance satin(const Rgb& f0) {
  return AnisotropicGgx{.alpha = 0.35, .anisotropy = 0.6, .f0 = f0};
}

enum class Taken { kAsMosaic, kAsRgb };

struct DyedCloth {
  Reflectance model;
  Rgb albedo = kDarkYarn;
  Taken taken = Taken::kAsMosaic;
  std::size_t pixels = 800;
  double noise = 0.005;
  double drift = 0, turn = 0, colour = 0;  // of the lights, one sigma
  double full = 1e9;                       // readings from here on are saturated
  Reflectance weft = model;                // of every other yarn, which lies across
};

// What is wrong with a light.
struct ColouredOff {
  double log_strength = 0;
  Vec3 turn;
  Rgb colour = {0, 0, 0};
};

struct ColouredReadings {
  LobeSamples samples{10};
  ChannelSamples channels{10};
  std::vector<Vec3> b, start;
};

// What the simulator reflects of a surface whose fibres run at an azimuth.
inline double reading_at(const Reflectance& model, const Rgb& albedo, Vec3 n, double azimuth, Vec3 l,
                         std::size_t c) {
  const double cosine = dot(n, l);
  if (!(cosine > 0)) return 0;
  const double x = std::cos(azimuth), y = std::sin(azimuth);
  const Vec3 t = normalized({x * n.z, y * n.z, -(x * n.x + y * n.y)}), s = cross(n, t);
  const auto local = [&](Vec3 d) { return Vec3{dot(d, t), dot(d, s), dot(d, n)}; };
  return kPi * cosine * simulator::evaluate(model, albedo, local(l), local({0, 0, 1}))[c];
}

class Photographed {
 public:
  Photographed(const DyedCloth& cloth, std::uint64_t seed) : cloth_(cloth), random_(seed) {
    for (int k = 0; k < 10; ++k) {
      ColouredOff off;
      off.log_strength = cloth.drift * random_.normal();
      const double x = random_.normal(), y = random_.normal(), z = random_.normal();
      off.turn = cloth.turn * Vec3{x, y, z};
      for (double& each : off.colour) each = cloth.colour * random_.normal();
      off_.push_back(off);
    }
  }

  ColouredReadings readings() {
    ColouredReadings all;
    for (std::size_t i = 0; i < cloth_.pixels; ++i) {
      const Vec3 n = random_normal(random_, 25);
      const double ink = 0.9 + 0.2 * random_.uniform();
      const bool is_weft = i % 8 >= 4;
      std::array<std::vector<LobeReading>, 3> of;
      for (std::size_t c = 0; c < 3; ++c) of[c] = of_channel(n, ink, is_weft, c);
      const std::size_t colour = i % 4 == 3 ? 1 : i % 4;
      const std::vector<LobeReading> fitted = cloth_.taken == Taken::kAsMosaic ? of[colour] : mixed(of);
      all.samples.add(fitted);
      all.start.push_back(lambert_fit(fitted));
      all.b.push_back(ink * cloth_.albedo[colour] * n);
      for (std::size_t c = 0; c < 3; ++c) {
        if (cloth_.taken == Taken::kAsRgb || c == colour) all.channels.add(i, of[c]);
      }
    }
    return all;
  }

 private:
  std::vector<LobeReading> of_channel(Vec3 n, double ink, bool is_weft, std::size_t c) {
    const std::vector<Vec3> told = ten_directions();
    std::vector<LobeReading> readings;
    Rgb albedo = cloth_.albedo;
    for (double& each : albedo) each *= ink;
    for (std::size_t k = 0; k < told.size(); ++k) {
      const Vec3 l = normalized(told[k] + off_[k].turn);
      const double bare =
          reading_at(is_weft ? cloth_.weft : cloth_.model, albedo, n, is_weft ? kPi / 2 : 0, l, c) *
          std::exp(off_[k].log_strength + off_[k].colour[c]);
      LitFrom from(told[k], {0, 0, 1});
      from.channel = static_cast<int>(c);
      readings.push_back(reading_of(bare, from, cloth_.noise, random_));
      if (bare >= cloth_.full) readings.back().weight = 0;
    }
    return readings;
  }

  // As LobeReader sums channels.
  static std::vector<LobeReading> mixed(const std::array<std::vector<LobeReading>, 3>& of) {
    std::vector<LobeReading> sum = of[1];
    for (std::size_t k = 0; k < sum.size(); ++k) {
      sum[k].x = 0;
      sum[k].from.channel = LitFrom::kMixed;
      bool counts = true;
      for (std::size_t c = 0; c < 3; ++c) {
        sum[k].x += kLuminance[c] * of[c][k].x;
        counts = counts && of[c][k].weight > 0;
      }
      sum[k].weight = counts ? 1 / std::pow(kLobeModelShare * std::max(sum[k].x, kLeastModelled), 2) : 0;
    }
    return sum;
  }

  const DyedCloth& cloth_;
  Random random_;
  std::vector<ColouredOff> off_;
};

struct FoundTints {
  std::vector<MeasuredLobe> grey, lobes;
};

inline FoundTints found_of(const ColouredReadings& r, double turn = 0) {
  FoundTints found;
  found.grey = found.lobes = measure_materials(r.samples, r.start, 1);
  const std::vector<double> errors = covariance_of_lights(0, turn);
  find_tints(r.samples, r.start, r.channels, {.light_errors = errors, .threads = 1}, found.lobes);
  return found;
}

/// Noise, lights and their colours are drawn anew for each seed; highlights are white.
inline DyedCloth white_cloth(std::uint64_t seed) {
  return {.model = seed % 2 == 0 ? ggx(kWhite) : satin(kWhite),
          .albedo = seed % 3 == 0 ? kRed : kDarkYarn,
          .taken = seed % 5 == 0 ? Taken::kAsRgb : Taken::kAsMosaic,
          .pixels = 500,
          .noise = 0.01,
          .drift = kLightDrift,
          .turn = 0.002,
          .colour = kColourDrift};
}
/// The same with golden ones.
inline DyedCloth golden_cloth(std::uint64_t seed) {
  DyedCloth cloth = white_cloth(seed);
  cloth.model = cloth.weft = seed % 2 == 0 ? ggx(kGold) : satin(kGold);
  cloth.albedo = kDarkYarn;
  cloth.taken = seed % 4 == 0 ? Taken::kAsRgb : Taken::kAsMosaic;
  cloth.pixels = 650;
  return cloth;
}

struct WhiteTrials {
  int measured = 0, called = 0, changed = 0;
  double farthest = 0;  ///< sigmas that a ratio is off 1
};
inline WhiteTrials white_trials(std::uint64_t count, std::uint64_t first) {
  WhiteTrials trials;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const DyedCloth cloth = white_cloth(seed);
    const ColouredReadings readings = Photographed(cloth, 100 + seed).readings();
    const FoundTints found = found_of(readings, cloth.turn);
    const MeasuredLobe& lobe = found.lobes.front();
    trials.called += lobe.tint ? 1 : 0;
    trials.changed += found.lobes.size() == found.grey.size() && lobe.lobe == found.grey.front().lobe ? 0 : 1;
    if (!lobe.is_measured()) continue;
    ++trials.measured;
    const auto tint = measure_tint(lobe.fit, false, readings.channels, {.threads = 1});
    for (std::size_t c = 0; tint && c < 3; ++c)
      trials.farthest = std::max(trials.farthest, std::abs(tint->tint[c] - 1) / tint->sigma_of_tint[c]);
  }
  return trials;
}

struct GoldenTrials {
  int found = 0, beyond = 0;  ///< three sigma
  double rms = 0;             ///< of errors of f0 over sigma
};
inline GoldenTrials golden_trials(std::uint64_t count, std::uint64_t first) {
  GoldenTrials trials;
  double squares = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const DyedCloth cloth = golden_cloth(seed);
    const FoundTints found = found_of(Photographed(cloth, 200 + seed).readings(), cloth.turn);
    if (!found.lobes.front().tint) continue;
    ++trials.found;
    const LobeTint& tint = *found.lobes.front().tint;
    for (std::size_t c = 0; c < 3; ++c) {
      const double off = (tint.f0[c] - kGold[c]) / tint.sigma[c];
      squares += off * off;
      trials.beyond += std::abs(off) > 3 ? 1 : 0;
    }
  }
  trials.rms = std::sqrt(squares / (3 * std::max(trials.found, 1)));
  return trials;
}

}  // namespace weft::solver
