// SPDX-License-Identifier: Apache-2.0
#include "bench/base/cloth_mosaics.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/parallel.h"
#include "core/vec.h"

namespace weft::bench {
namespace {

constexpr double kAlbedo = 0.4, kPeriod_px = 24, kSteepest_deg = 12, kLobe = 0.2, kExponent = 24;
constexpr double kElectronsPerCount = 2.7, kReadNoise = 1.2;  // counts

// A standard normal deviate that belongs to a number (splitmix64, Steele et al. 2014; Box and Muller 1958).
double deviate(std::uint64_t number) {
  std::uint64_t z = (number + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  const double u = (static_cast<double>(z >> 32) + 0.5) * 0x1p-32,
               v = static_cast<double>(z & 0xffffffffu) * 0x1p-32;
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * kPi * v);
}

Vec3 weave_normal(int x, int y) {
  const double slope = std::tan(radians(kSteepest_deg)) / std::sqrt(2.0), turn = 2 * kPi / kPeriod_px;
  return normalized({slope * std::sin(turn * x), slope * std::sin(turn * y), 1});
}

// Of the light of strength 1.
double reflected(Cloth cloth, Vec3 n, Vec3 l) {
  const double diffuse = kAlbedo * std::max(0.0, dot(n, l));
  if (cloth == Cloth::kSmooth) return diffuse;
  const Vec3 half = normalized(l + Vec3{0, 0, 1});
  return diffuse + kLobe * std::pow(std::max(0.0, dot(n, half)), kExponent);
}

}  // namespace

void put_cloth(pipeline::Photographs& photographs, Cloth cloth, int threads) {
  const double seconds = 1 / 100.0;  // as grey mosaics are exposed
  for (std::size_t k = 0; k < photographs.count(); ++k) {
    RawFrame& frame = photographs.mosaics()->frames[k];
    const double black = frame.black[0][0], range = frame.white - black;
    parallel_for(static_cast<std::size_t>(photographs.size.height), threads, [&](std::size_t row, int) {
      const int y = static_cast<int>(row);
      for (int x = 0; x < photographs.size.width; ++x) {
        const LightField::Light light = photographs.field->at(k, frame.cfa.channel_at(x, y), x, y);
        const double counts =
            light.strength * seconds * range * reflected(cloth, weave_normal(x, y), light.direction);
        const std::uint64_t site = (k * static_cast<std::size_t>(photographs.size.height) + row) * 0x100000 +
                                   static_cast<unsigned>(x);
        const double sigma = std::sqrt(counts / kElectronsPerCount + kReadNoise * kReadNoise);
        frame.counts(x, y) = static_cast<std::uint16_t>(
            std::lround(std::clamp(black + counts + sigma * deviate(site), 0.0, double{frame.white})));
      }
    });
  }
}

}  // namespace weft::bench
