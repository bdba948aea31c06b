// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "core/base/result.h"
#include "core/image/image.h"
#include "exchange/blocks/block_format.h"

namespace weft::exchange {

/// What graphics hardware samples from blocks: channels_of() planes of 0 to 1, without the padding. By the
/// specification alone, apart from the encoders. bc7 is exact, multiples of 1 / 255, and of mode 6 alone. bc1
/// to bc5 are interpolated between end points as fractions; hardware may be 1 / 255 off. The transparent
/// black of bc1 is black. kBadData for a wrong number of bytes and for another mode of bc7, kUsage for a size
/// without pixels.
Result<Image<float>> decode_blocks(BlockFormat format, std::string_view blocks, Size size, int threads = 0);

}  // namespace weft::exchange
