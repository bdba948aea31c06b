// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "core/image/image.h"

// Which pixels of a picture a texel of a smaller level covers, in sizes that graphics hardware has.

namespace weft::material {

/// Width and height of a level: halves, rounded down, never below 1.
inline Size size_of_level(Size size, int level) {
  return {std::max(1, size.width >> level), std::max(1, size.height >> level)};
}

/// The level of 1 x 1 texels.
inline int last_level(Size size) {
  return static_cast<int>(std::bit_width(static_cast<unsigned>(std::max({size.width, size.height, 1})))) - 1;
}

/// The part of `fine` pixels in a row that texel `at` of `coarse` in the same row covers.
struct Box {
  int first = 0, count = 0;

  Box(int at, int coarse, int fine) : coarse_(coarse) {
    begin_ = std::int64_t{at} * fine;
    end_ = begin_ + fine;
    first = static_cast<int>(begin_ / coarse);
    count = static_cast<int>((end_ + coarse - 1) / coarse) - first;
  }

  /// How much of pixel `first` + i it covers, 0 to 1.
  double share(int i) const {
    const std::int64_t from = std::int64_t{first + i} * coarse_, to = from + coarse_;
    return static_cast<double>(std::min(to, end_) - std::max(from, begin_)) / coarse_;
  }

 private:
  std::int64_t begin_ = 0, end_ = 0;  // in units of 1 / coarse pixels
  int coarse_ = 1;
};

}  // namespace weft::material
