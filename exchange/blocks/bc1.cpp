// SPDX-License-Identifier: Apache-2.0
#include <squish.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "exchange/blocks/strip.h"

namespace weft::exchange {

void encode_bc1(const StripRows& strip, bool has_three_steps, std::uint8_t* blocks, std::size_t step) {
  // kDxt3, unlike the other kind with four steps alone, wastes no time on alpha.
  const int kind = has_three_steps ? squish::kDxt1 : squish::kDxt3;
  for (std::size_t b = 0; b < strip.blocks; ++b) {
    std::array<squish::u8, 64> texels = {};
    for (std::size_t i = 0; i < 16; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        texels[4 * i + c] = static_cast<squish::u8>(strip.rows[c][i / 4][4 * b + i % 4] + 0.5F);
      }
      texels[4 * i + 3] = 255;
    }
    std::array<std::uint8_t, 16> block = {};
    squish::Compress(texels.data(), block.data(), kind | squish::kColourRangeFit);
    std::memcpy(blocks + b * step, block.data() + (has_three_steps ? 0 : 8), 8);
  }
}

}  // namespace weft::exchange
