// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/image/image.h"
#include "core/image/raw_frame.h"

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

/// Pixels to either side over which a share is measured.
inline constexpr int kShareReach = 1;
/// Rows that sharpening looks at above and below what it sharpens.
inline constexpr int kSharpenReach = kDeblurReach + kShareReach;

/// Rows of solved maps, (0, 0) of each view being column 0 of the image's row `first_row`.
struct RowsToSharpen {
  Size image;
  int first_row = 0;
  std::optional<CfaPattern> cfa;  ///< of a mosaic: each normal was measured in its photosite's own colour
  std::array<View<const float>, 3> normal, albedo, sigma_albedo;
  View<const float> sigma_normal_deg;
  View<const std::uint16_t> status;

  /// The colour that a pixel's normal was measured in; green of RGB.
  std::size_t own_colour(int x, int y) const {
    return cfa ? static_cast<std::size_t>(cfa->channel_at(x, y)) : 1;
  }
};

/// Rows of what becomes of them, (0, 0) being column 0 of row `first_row`.
struct SharpenedRows {
  int first_row = 0;
  std::array<View<float>, 3> normal, albedo, sigma_albedo;
  View<float> sigma_normal_deg;
};

/// Sharpens albedo times normal in each colour over `area` of the image by best_share() of the filters'
/// correction, measured around each pixel by how far it would turn the normals. A filter may look at what was
/// measured in other colours: albedo is known in all of them. What has no solution stays as it is, with all
/// that it would enter. Returns the sum of the shares over the area.
double sharpen(const RowsToSharpen& rows, const std::array<DeblurFilter, 3>& filters, Rect area,
               const SharpenedRows& out);

}  // namespace weft::solver
