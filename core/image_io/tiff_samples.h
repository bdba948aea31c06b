// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/image/image.h"
#include "core/image_io/image_io.h"

namespace weft {

/// How a TIFF stores a number.
struct TiffSample {
  enum class Kind { kCount, kSigned, kFloat } kind = Kind::kCount;
  int bits = 8;

  bool is_known() const;
  SampleType type() const;
};

/// Numbers `first`, `first + step` ... of a decoded row that holds them all, of a known kind; counts and
/// signed ones by their full scale.
void unpack_tiff(const std::byte* row, TiffSample sample, std::size_t first, std::size_t step,
                 View<float> out);
/// The first `count` counts of such a row, unscaled; at most 16 bits each.
void unpack_indices(const std::byte* row, int bits, std::size_t count, std::vector<std::uint16_t>& out);

}  // namespace weft
