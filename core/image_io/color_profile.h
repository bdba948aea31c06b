// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/image_io/image_io.h"

// ICC profiles (ICC.1:2022), by which a TIFF says what its colours are.

namespace weft {

/// A profile of sRGB: always the same bytes.
std::vector<std::uint8_t> srgb_profile();

/// By the curve of red or grey; primaries are not looked at. kData where the profile has no such curve, as
/// one of tables, or is damaged.
ColorSpace color_of_profile(std::span<const std::uint8_t> profile);

/// The space of a display whose light is the power `gamma` of its signal. 2.2 counts as sRGB.
ColorSpace color_of_gamma(double gamma);

}  // namespace weft
