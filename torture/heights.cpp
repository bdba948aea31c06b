// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <limits>

#include "bench/oracles/oracle_rig.h"
#include "solver/height/height.h"
#include "torture/hard_case.h"

namespace weft::torture {
namespace {

constexpr Size kReliefSize = {128, 96};

/// A surface by its height in pixels, and the normals that are seen of it.
struct Relief {
  std::function<double(int x, int y)> height;
  std::function<Vec3(int x, int y)> normal;
  std::function<bool(int x, int y)> counts = [](int, int) { return true; };  ///< where heights are compared
};

/// Waves of 24 pixels, up to 38 degrees steep.
double wave(int x, int y) {
  return 3 * std::sin(2 * kPi * x / 24) * std::cos(2 * kPi * y / 24);
}
Vec3 wave_normal(int x, int y) {
  const double k = 2 * kPi / 24;
  return normalized(
      {-3 * k * std::cos(k * x) * std::cos(k * y), -3 * k * std::sin(k * x) * std::sin(k * y), 1});
}

/// Rms of heights less the truth, both about their means; none where one is no number.
std::optional<double> rms_off(const Relief& relief, const std::function<double(int, int)>& height) {
  double sum = 0, squares = 0, count = 0;
  for (int y = 0; y < kReliefSize.height; ++y) {
    for (int x = 0; x < kReliefSize.width; ++x) {
      if (!relief.counts(x, y)) continue;
      const double off = height(x, y) - relief.height(x, y);
      sum += off;
      squares += off * off;
      count += 1;
    }
  }
  const double mean = sum / count, rms = std::sqrt(squares / count - mean * mean);
  return std::isfinite(rms) ? std::optional(rms) : std::nullopt;
}

/// Slopes -nx / nz and ny / nz summed by trapezoids, down the left column and then along each row.
Image<double> by_paths(const Relief& relief) {
  const auto right = [&](int x, int y) { return -relief.normal(x, y).x / relief.normal(x, y).z; };
  const auto down = [&](int x, int y) { return relief.normal(x, y).y / relief.normal(x, y).z; };
  Image<double> height(kReliefSize);
  for (int y = 0; y < kReliefSize.height; ++y) {
    if (y > 0) height(0, y) = height(0, y - 1) + (down(0, y - 1) + down(0, y)) / 2;
    for (int x = 1; x < kReliefSize.width; ++x)
      height(x, y) = height(x - 1, y) + (right(x - 1, y) + right(x, y)) / 2;
  }
  return height;
}

HardCase relief_case(const char* what, double within, const Relief& relief) {
  Image<float> normal(kReliefSize, 3);
  for (int y = 0; y < kReliefSize.height; ++y) {
    for (int x = 0; x < kReliefSize.width; ++x) {
      const Vec3 n = relief.normal(x, y);
      normal(x, y, 0) = static_cast<float>(n.x);
      normal(x, y, 1) = static_cast<float>(n.y);
      normal(x, y, 2) = static_cast<float>(n.z);
    }
  }
  const Image<double> plain = by_paths(relief);
  HardCase hard = {.stage = "height",
                   .what = what,
                   .unit = "pixels of height, rms",
                   .plain = rms_off(relief, [&](int x, int y) { return plain(x, y); }),
                   .ours = {},
                   .within = within};
  const Result<solver::Height> height =
      solver::height_from_normals({normal.plane(0), normal.plane(1), normal.plane(2)}, {}, {});
  if (!height) {
    hard.flag = "refused: " + height.error().what;
    return hard;
  }
  hard.ours = rms_off(relief, [&](int x, int y) { return double{height->height_mm(x, y)}; });
  if (const auto left = kReliefSize.pixels() - height->pixels; left > 0)
    hard.flag = fmt::format("{} pixels left out", left);
  if (height->clamped > 0)
    hard.flag += fmt::format("{}{} pixels clamped", hard.flag.empty() ? "" : ", ", height->clamped);
  return hard;
}

bool in_hole(int x, int y) {
  return std::hypot(x - 50, y - 40) < 12;
}

HardCase holed_cloth() {
  HardCase hard = relief_case("cloth with a hole of 24 pixels", 0.1,
                              {.height = wave,
                               .normal =
                                   [](int x, int y) {
                                     constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
                                     return in_hole(x, y) ? Vec3{kNothing, 0, 0} : wave_normal(x, y);
                                   },
                               .counts = [](int x, int y) { return !in_hole(x, y); }});
  hard.must_say = "pixels left out";
  return hard;
}

HardCase noisy_normals() {
  test::Random random(5);
  Image<double> noise(kReliefSize, 2);
  for (int y = 0; y < kReliefSize.height; ++y) {
    for (int x = 0; x < kReliefSize.width; ++x) {
      for (int p = 0; p < 2; ++p) noise(x, y, p) = radians(3) * random.normal();
    }
  }
  return relief_case("normals with three degrees of noise", 0.15,
                     {.height = wave, .normal = [&](int x, int y) {
                        return normalized(wave_normal(x, y) + Vec3{noise(x, y, 0), noise(x, y, 1), 0});
                      }});
}

/// A ridge whose crest is a fold: one column of normals lies flat, one is turned away.
HardCase folded_cloth() {
  constexpr int kFold = 64;
  HardCase hard = relief_case("a fold: normals that lie flat or are turned away", 1,
                              {.height = wave,
                               .normal =
                                   [](int x, int y) {
                                     if (y == 40 && x == kFold) return Vec3{1, 0, 0};
                                     if (y == 40 && x == kFold + 1) return normalized({-1, 0, -1e-3});
                                     return wave_normal(x, y);
                                   },
                               .counts = [](int x, int y) { return std::hypot(x - kFold, y - 40) > 3; }});
  hard.must_say = "pixels clamped";
  return hard;
}

}  // namespace

std::vector<HardCase> hard_heights() {
  return {holed_cloth(), noisy_normals(), folded_cloth()};
}

}  // namespace weft::torture
