// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace weft::solver {

/// Pixels to either side that a filter looks at.
inline constexpr int kDeblurReach = 4;

/// What undoes a blur along x and then along y: the same symmetric weights for both.
struct DeblurFilter {
  std::array<float, kDeblurReach + 1> weights = {1};  ///< at 0, and at 1 to kDeblurReach on either side

  /// Variance of what the filter makes of white noise of variance 1, of what it adds to it, and the
  /// covariance of what it adds with that noise.
  double kept_variance() const;
  double added_variance() const;
  double added_covariance() const;
};

/// The weights of least squares that turn a Gaussian of `sigma_px` into a point: the Wiener filter for a
/// signal of even spectrum, kDeblurReach long, that leaves a constant as it is. `noise` is the variance of
/// noise over that of the signal: frequencies that the blur left less of are not brought back.
DeblurFilter deblur_filter(double sigma_px, double noise);

/// The share of a correction that leaves the least expected error (Wiener's). `correction` is its mean
/// square, noise included; `noise` is what noise makes of that, its covariance with the noise of what is
/// corrected included. Noise counts twice, as the mean is taken over few pixels: 0 where it explains half of
/// it.
inline float best_share(float correction, float noise) {
  return correction > 2 * noise ? 1 - 2 * noise / correction : 0;
}

}  // namespace weft::solver
