// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image/image.h"

// A row of blocks on its way into an encoder.

namespace weft::exchange {

/// Texels of a row of blocks, 0 to 255 and not rounded. `rows[c][y]` may be read in whole groups of
/// kRowGroup.
struct StripRows {
  std::array<std::array<const float*, 4>, 4> rows = {};
  std::size_t blocks = 0;
};

/// Room for one row of blocks.
class Strip {
 public:
  Strip(int planes, Size size);
  /// Takes texel rows 4 `block_row` to 4 `block_row` + 3, clamped to 0 and 1, the borders repeated.
  StripRows take(std::span<const View<const float>> planes, int block_row);

 private:
  std::size_t stride_;
  std::vector<float> data_;
};

/// bc7 of mode 6: 16 bytes a block. `channels` is 3 or 4.
void encode_bc7(const StripRows& strip, int channels, std::uint8_t* blocks);

/// bc4 of one channel: 8 bytes every `step` bytes from `blocks` on.
void encode_bc4(const StripRows& strip, int channel, std::uint8_t* blocks, std::size_t step);

/// bc1 by libsquish: 8 bytes every `step` bytes. `has_three_steps`: a block may have three colours and black,
/// as in a file of bc1 and never in bc3.
void encode_bc1(const StripRows& strip, bool has_three_steps, std::uint8_t* blocks, std::size_t step);

}  // namespace weft::exchange
