// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/image/image.h"

namespace weft::report {

/// The longest side of a preview unless asked otherwise, in pixels.
inline constexpr int kPreviewSide = 1024;

/// Averages planes over squares of whole pixels (a box filter on linear values), so that the longest side
/// becomes `longest_side` at most. It is fed bands of rows from the top, so nobody needs the whole image;
/// sums are in double and in the order of rows, so the result does not depend on the bands, and a constant
/// stays that constant.
///
/// A pixel is missing where a plane is not finite or its status says kNoSolution. Missing pixels are left out
/// of the averages; a square with half of its pixels missing, or more, is NaN.
class Downsampler {
 public:
  Downsampler(Size size, int planes, int longest_side = kPreviewSide);

  /// The next rows: one view a plane, of equal size, with their status if there is one. Rows beyond the last
  /// are ignored.
  void add_rows(std::span<const View<const float>> planes, View<const std::uint16_t> status = {});

  /// The averages; NaN in squares whose rows have not all come yet.
  const Image<float>& averages() const { return averages_; }
  /// Pixels that were left out, so that a preview which hides some can say so.
  std::int64_t missing() const { return missing_; }
  /// The side of a square in pixels.
  int square() const { return square_; }

 private:
  void finish_squares();

  Size size_;
  int square_;
  int rows_ = 0;
  std::int64_t missing_ = 0;
  Image<float> averages_;
  Image<double> column_sums_;  // over the rows of the squares being filled
  std::vector<std::uint32_t> column_counts_;
  std::vector<float> weight_;  // 1 for the valid pixels of a row, 0 for missing ones
};

}  // namespace weft::report
