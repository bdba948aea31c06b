// SPDX-License-Identifier: Apache-2.0
#include "tests/material/maps/slopes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "bench/oracles/oracle_rig.h"

namespace weft::material {
namespace {

/// Two crossing sets of parabolic yarns whose axes rise and fall.
class TestWeave {
 public:
  TestWeave(double pitch, const WeaveFaults& faults)
      : pitch_(pitch),
        cosine_(std::cos(radians(faults.turn_deg))),
        sine_(std::sin(radians(faults.turn_deg))) {
    test::Random random(17);
    jitter_.resize(4096);
    for (double& j : jitter_) j = faults.jitter * random.normal();
  }
  double height(double x, double y) const {
    const double u = (x * cosine_ + y * sine_) / pitch_, v = (y * cosine_ - x * sine_) / pitch_;
    const double i = std::floor(u), j = std::floor(v);
    const double across = u - i - 0.5 - jitter_[index(i)], along = v - j - 0.5 - jitter_[index(j + 2000)];
    const double over = std::fmod(std::abs(i + j), 2) < 0.5 ? 0.08 : -0.08;
    return pitch_ * std::max(over * std::cos(kPi * (v - j - 0.5)) - 0.8 * across * across,
                             -over * std::cos(kPi * (u - i - 0.5)) - 0.8 * along * along);
  }

 private:
  static std::size_t index(double yarn) { return static_cast<std::size_t>(yarn + 1000) % 4096; }
  double pitch_, cosine_, sine_;
  std::vector<double> jitter_;
};

}  // namespace

TestSlopes level_slopes(Size size) {
  return {Image<float>(size), Image<float>(size)};
}

TestSlopes weave_slopes(Size size, double pitch_px, const WeaveFaults& faults) {
  const TestWeave weave(pitch_px, faults);
  TestSlopes s = level_slopes(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      s.right(x, y) = static_cast<float>(weave.height(x + 0.5, y) - weave.height(x - 0.5, y));
      s.up(x, y) = static_cast<float>(weave.height(x, y - 0.5) - weave.height(x, y + 0.5));
    }
  }
  return s;
}

void add_noise(TestSlopes& slopes, double sigma_deg, std::uint64_t seed) {
  test::Random random(seed);
  for (Image<float>* plane : {&slopes.right, &slopes.up}) {
    for (int y = 0; y < plane->height(); ++y) {
      for (int x = 0; x < plane->width(); ++x) {
        (*plane)(x, y) += static_cast<float>(radians(sigma_deg) / std::sqrt(2.0) * random.normal());
      }
    }
  }
}

TestSlopes moved(const TestSlopes& slopes, int dx, int dy) {
  TestSlopes out = level_slopes(slopes.right.size());
  for (int y = 0; y < out.right.height(); ++y) {
    for (int x = 0; x < out.right.width(); ++x) {
      const int to_x = (x + dx) % out.right.width(), to_y = (y + dy) % out.right.height();
      out.right(to_x, to_y) = slopes.right(x, y);
      out.up(to_x, to_y) = slopes.up(x, y);
    }
  }
  return out;
}

bool same_floats(const Image<float>& a, const Image<float>& b) {
  if (a.size() != b.size() || a.planes() != b.planes()) return false;
  for (int p = 0; p < a.planes(); ++p) {
    for (int y = 0; y < a.height(); ++y) {
      const std::size_t bytes = sizeof(float) * static_cast<std::size_t>(a.width());
      if (std::memcmp(a.plane(p).row(y), b.plane(p).row(y), bytes) != 0) return false;
    }
  }
  return true;
}

}  // namespace weft::material
