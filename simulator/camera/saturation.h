// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "simulator/camera/camera_settings.h"

namespace weft::simulator {

/// A sensor that is not quite linear: the exact inverse of lin(v) = v (1 + a v + b v^2), core's
/// Response::linearity of a channel, for v from -1/4 to 1. Outside it goes on as a straight line. With
/// a = b = 0 it changes nothing.
class NonLinearity {
 public:
  /// kBadData where lin does not rise by at least 1/10 everywhere from -1/4 to 1.
  static Result<NonLinearity> of(std::array<double, 2> a_and_b);

  /// The v with lin(v) = signal, to 1e-15: Newton's method inside a bracket.
  double distorted(double signal) const;

 private:
  explicit NonLinearity(std::array<double, 2> a_and_b) : a_(a_and_b[0]), b_(a_and_b[1]) {}
  double linear(double v) const { return v * (1 + v * (a_ + b_ * v)); }
  double slope(double v) const { return 1 + v * (2 * a_ + 3 * b_ * v); }

  double a_, b_;
};

/// Charge above a full well runs along the column. Of the excess of a photosite, weights[0] goes to each of
/// its two neighbours, weights[1] to the next, and so on; what the weights leave is drained.
struct BloomKernel {
  std::vector<double> weights;
  int radius() const { return static_cast<int>(weights.size()); }
};

/// Weights fall by `decay` a photosite down to a thousandth of the first and sum to `share` over both sides;
/// the radius is at most 66. Without share there are none.
BloomKernel bloom_kernel(const BloomSettings& settings);

/// Takes the excess over `full` from each photosite and spills it. `in` lies on `out_rect` grown by the
/// kernel's radius above and below, also beyond the frame. One pass without cascade: where the spill lands
/// on a full photosite it stands above `full`, and the converter clips it. One sample a pixel, by rows.
void bloom(const BloomKernel& kernel, double full, std::span<const double> in, Rect out_rect,
           std::span<double> out);

}  // namespace weft::simulator
