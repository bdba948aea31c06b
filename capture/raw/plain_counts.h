// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "capture/raw/dng_layout.h"
#include "core/image/image.h"

namespace weft::capture {

/// Reads uncompressed counts of the rectangle `active` into `out`, which has its size. False where the file
/// ends before they do.
bool read_plain_counts(const PlainCounts& plain, Size stored, Rect active, const ReadAt& read_at,
                       View<std::uint16_t> out);

}  // namespace weft::capture
