// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "core/image_io/image_io.h"

namespace weft {

/// Bytes of one sample.
std::size_t sample_bytes(SampleType type);

/// Interleaves one row of `width` samples a plane into `packed`, native and without gaps, the same bits on
/// every SIMD target:
/// - kUint8, kUint16: `max * min(v, 1)` to the nearest integer, ties to even; 0 where v is not above 0 (NaN).
/// - kHalf: IEEE 754 binary16, nearest, ties to even; finite values stay finite, at most 65504; NaN is quiet.
/// - kFloat: every bit.
void pack_row(std::span<const float* const> planes, std::size_t width, SampleType type, std::byte* packed);

}  // namespace weft
