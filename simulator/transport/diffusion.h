// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/image/image.h"

namespace weft::simulator {

/// Where light that enters a thin sheet leaves it. What diffuses in a plane while it is absorbed has the
/// Green's function K0(r / l) / (2 pi l^2), and that is the mean of Gaussians of variance 2 l^2 t over an
/// exponential t: here the two at the nodes of Gauss-Laguerre, with l such that the mean distance is exact.
/// Behind the edge of a shadow that is within 0.03 of the light beside it.
class Diffusion {
 public:
  /// @param mean_px mean distance between where light enters and where it leaves, from 0
  explicit Diffusion(double mean_px);

  /// Pixels that light comes from beyond those that are filled.
  int radius() const { return static_cast<int>(gaussians_.back().profile.size() / 2); }

  /// Adds to `left`, by rows of `out_rect`, the share that leaves there of what entered on `out_rect` grown
  /// by radius(). No light is lost.
  void add(std::span<const double> entered, Rect out_rect, std::span<double> left) const;

 private:
  struct Gaussian {
    double share;
    std::vector<double> profile;  ///< along a row and along a column; an odd number, sum 1
  };
  std::vector<Gaussian> gaussians_;  ///< the widest last
};

}  // namespace weft::simulator
