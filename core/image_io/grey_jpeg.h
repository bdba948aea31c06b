// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/image/image.h"

namespace weft {

/// The luma of a JPEG in memory, as it is stored: not turned, and grey where its data end early. Nothing
/// where it is no JPEG of grey or YCbCr, or has more than 64 megapixels, which no live picture has.
std::optional<Image<std::uint8_t>> grey_of_jpeg(std::string_view jpeg);

}  // namespace weft
