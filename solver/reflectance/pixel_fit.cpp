// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/pixel_fit.h"

#include <algorithm>
#include <cmath>

namespace weft::solver {
namespace {

// The longest step over the length of b: a lobe turns so much over it that slopes say nothing beyond.
constexpr double kMostStep = 0.3;
// How often a step that wins nothing is halved; after that the pixel is where it can get.
constexpr int kMostHalvings = 4;
constexpr double kLeastFall = 1e-9;  // of the cost: a step that wins less is the last

}  // namespace

int used_of(std::span<const LobeReading> readings) {
  return static_cast<int>(std::ranges::count_if(readings, [](const LobeReading& r) { return r.weight > 0; }));
}

double huber_weight(double residual_sigmas) {
  const double size = std::abs(residual_sigmas);
  return size < kHuberSigmas ? 1 : kHuberSigmas / size;
}

double cost_of(const Lobe& lobe, std::span<const LobeReading> readings, Vec3 b, double yarn) {
  double cost = 0;
  for (const LobeReading& r : readings) {
    if (r.weight == 0) continue;
    const double size = std::abs(r.x - modelled(lobe, b, r.from, yarn)) * std::sqrt(r.weight);
    cost += size < kHuberSigmas ? 0.5 * size * size : kHuberSigmas * (size - 0.5 * kHuberSigmas);
  }
  return cost;
}

void PixelSystem::add(Vec3 j, double weight, double residual) {
  const Vec3 wj = weight * j;
  a[0] += wj.x * j.x;
  a[1] += wj.x * j.y;
  a[2] += wj.x * j.z;
  a[3] += wj.y * j.y;
  a[4] += wj.y * j.z;
  a[5] += wj.z * j.z;
  gradient = gradient + residual * wj;
}

void PixelSystem::regularise() {
  const double little = 1e-9 * (a[0] + a[3] + a[5]) + 1e-30;
  for (const std::size_t diagonal : {0U, 3U, 5U}) a[diagonal] += little;
}

Vec3 PixelSystem::solved(Vec3 right) const {
  // Cholesky's factor, row by row.
  const double l00 = std::sqrt(a[0]), l10 = a[1] / l00, l20 = a[2] / l00;
  const double l11 = std::sqrt(std::max(a[3] - l10 * l10, 1e-30)), l21 = (a[4] - l20 * l10) / l11;
  const double l22 = std::sqrt(std::max(a[5] - l20 * l20 - l21 * l21, 1e-30));
  const double y0 = right.x / l00, y1 = (right.y - l10 * y0) / l11;
  const double z = (right.z - l20 * y0 - l21 * y1) / (l22 * l22);
  const double y = (y1 - l21 * z) / l11;
  return {(y0 - l10 * y - l20 * z) / l00, y, z};
}

namespace {

PixelSystem system_of(const Lobe& lobe, std::span<const LobeReading> readings, Vec3 b, double yarn) {
  PixelSystem system;
  for (const LobeReading& r : readings) {
    if (r.weight == 0) continue;
    const ModelledReading m = modelled_with_derivative(lobe, b, r.from, yarn);
    const double residual = r.x - m.x;
    system.add(m.by_b, r.weight * huber_weight(residual * std::sqrt(r.weight)), residual);
  }
  system.regularise();
  return system;
}

}  // namespace

PixelFit fit_pixel(const Lobe& lobe, std::span<const LobeReading> readings, Vec3 start, double yarn,
                   int steps) {
  PixelFit fit = {start, cost_of(lobe, readings, start, yarn)};
  for (int i = 0; i < steps; ++i) {
    const PixelSystem system = system_of(lobe, readings, fit.b, yarn);
    Vec3 step = system.solved(system.gradient);
    const double size = length(step), most = kMostStep * length(fit.b);
    if (!std::isfinite(size)) break;
    if (size > most) step = (most / size) * step;
    double cost = cost_of(lobe, readings, fit.b + step, yarn);
    for (int halved = 0; halved < kMostHalvings && cost > fit.cost; ++halved) {
      step = 0.5 * step;
      cost = cost_of(lobe, readings, fit.b + step, yarn);
    }
    if (!(cost < fit.cost)) break;
    const bool is_settled = fit.cost - cost < kLeastFall * fit.cost;
    fit = {fit.b + step, cost};
    if (is_settled) break;
  }
  return fit;
}

}  // namespace weft::solver
