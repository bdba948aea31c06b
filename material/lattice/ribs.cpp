// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/vec.h"
#include "material/lattice/search.h"

namespace weft::material {
namespace {

constexpr double kNear_px = 4, kOfLevel = 0.7;

Vec2 direction(double angle_deg) {
  return {std::cos(radians(angle_deg)), std::sin(radians(angle_deg))};
}

// The least correlation along a ray, each against its channel's level.
double least_along(Vec2 way, std::span<const Correlation* const> slopes, std::span<const double> levels) {
  double least = std::numeric_limits<double>::infinity();
  const double far = 0.6 * slopes[0]->reach();
  for (double r = kNear_px; r < far; r += 1) {
    double sum = 0;
    for (std::size_t i = 0; i < slopes.size(); ++i) sum += slopes[i]->at(r * way).value_or(0) / levels[i];
    least = std::min(least, sum / static_cast<double>(slopes.size()));
  }
  return least;
}

}  // namespace

std::optional<Vec2> repeat_of_ribs(std::span<const Correlation* const> slopes,
                                   std::span<const double> levels) {
  double along_deg = 0, best = 0;
  const auto look = [&](double angle) {
    const double least = least_along(direction(angle), slopes, levels);
    if (least > best) along_deg = angle, best = least;
  };
  for (int i = 0; i < 720; ++i) look(0.25 * i);
  const double coarse_deg = along_deg;
  for (int i = -25; i <= 25; ++i) look(coarse_deg + 0.01 * i);
  if (best < kOfLevel) return std::nullopt;

  // The first strong top across the ribs, then its multiples in reach.
  const Correlation mean = mean_of(slopes);
  const Vec2 across = direction(along_deg + 90);
  const auto value = [&](double r) { return mean.at(r * across).value_or(-1); };
  double pitch = 0, level = 0;
  const double far = 0.6 * mean.reach();
  for (double r = kNear_px; r < far; r += 0.25) level = std::max(level, value(r));
  const auto top_near = [&](double r0, double r1) {
    double top = r0;
    for (double r = r0; r <= r1; r += 0.05) {
      if (value(r) > value(top)) top = r;
    }
    return top;
  };
  for (double r = kNear_px; r < far && pitch == 0; r += 0.25) {
    if (value(r) > 0.85 * level && value(r) >= value(r - 0.25) && value(r) > value(r + 0.25))
      pitch = top_near(r - 0.5, r + 0.5);
  }
  if (pitch == 0) return std::nullopt;
  // Least squares of the multiples' places on their numbers.
  double products = pitch, squares = 1;
  for (int times = 2; times * pitch < far; ++times) {
    products += times * top_near((times - 0.2) * pitch, (times + 0.2) * pitch);
    squares += times * times;
    pitch = products / squares;
  }
  const Vec2 repeat = pitch * across;
  return repeat.x < 0 ? -1 * repeat : repeat;
}

}  // namespace weft::material
