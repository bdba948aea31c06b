// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/image/image.h"

namespace weft::exchange {

/// A PNG of samples from 0 to 1, pixel by pixel with `channels` (1, 3 or 4) each, in 8 or 16 bits.
std::string png_bytes(Size size, int channels, int bits, const std::vector<double>& samples);

}  // namespace weft::exchange
