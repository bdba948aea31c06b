// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "core/base/vec.h"
#include "solver/reflectance/lobe.h"

namespace weft::solver {

/// One reading of a pixel: over its strength, and one over its variance. 0 leaves it out.
struct LobeReading {
  LitFrom from;
  double x = 0;
  double weight = 0;
};

/// How many have a weight.
int used_of(std::span<const LobeReading> readings);

/// What no noise model knows, as a share of a reading, which counts as kLeastModelled at least. Without it
/// a lobe would follow the best-lit pixels alone.
inline constexpr double kLobeModelShare = 0.01;
inline constexpr double kLeastModelled = 0.02;  ///< darker readings count as this bright
/// A residual counts as a square up to so many sigma, beyond as its size (Huber 1964).
inline constexpr double kHuberSigmas = 3;

/// Normal and albedo of one pixel as one vector, b = rho n, for a lobe that is known.
struct PixelFit {
  Vec3 b;
  double cost = 0;  ///< half of the sum of squared residuals over sigma, Huber's
};

/// Huber's cost of a pixel.
double cost_of(const Lobe& lobe, std::span<const LobeReading> readings, Vec3 b, double yarn);

/// Gauss-Newton from `start`, at most so many steps, each at most 0.3 |b| and halved until the cost falls.
PixelFit fit_pixel(const Lobe& lobe, std::span<const LobeReading> readings, Vec3 start, double yarn,
                   int steps);

/// The normal equations of a pixel.
struct PixelSystem {
  std::array<double, 6> a = {};  ///< xx, xy, xz, yy, yz, zz of J^T W J
  Vec3 gradient;                 ///< J^T W (x - model)

  void add(Vec3 derivative, double weight, double residual);
  /// A billionth of the trace more on the diagonal, so that every pixel has a solution.
  void regularise();
  Vec3 solved(Vec3 right) const;
};

/// Huber's weight over that of a square: 1 up to kHuberSigmas, then falling.
double huber_weight(double residual_sigmas);

}  // namespace weft::solver
