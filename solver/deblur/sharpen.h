// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "solver/deblur/filter.h"

namespace weft::solver {

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
