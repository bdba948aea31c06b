// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "core/image/image.h"

// Block formats of graphics hardware: 4 x 4 texels in 8 or 16 bytes (Microsoft, "Texture Block Compression in
// Direct3D 11"; Khronos Data Format Specification 1.3, chapters 18 to 20).

namespace weft::exchange {

enum class BlockFormat {
  kBc1,  ///< colour of 5:6:5 bits, four steps along a line: 8 bytes
  kBc3,  ///< the same, and alpha as in kBc4: 16 bytes
  kBc4,  ///< one channel of 8 bits, eight steps: 8 bytes
  kBc5,  ///< two of them: 16 bytes
  kBc7,  ///< colour and alpha of 8 bits, sixteen steps along a line (mode 6 alone is written): 16 bytes
};

inline constexpr std::array<BlockFormat, 5> kBlockFormats = {
    BlockFormat::kBc1, BlockFormat::kBc3, BlockFormat::kBc4, BlockFormat::kBc5, BlockFormat::kBc7};
/// "bc1" ... "bc7".
const char* name_of(BlockFormat format);
std::optional<BlockFormat> block_format_named(std::string_view name);

/// Bytes of a block: 8 or 16.
std::size_t block_bytes(BlockFormat format);
/// Channels that a texel has when it is decoded: 3, 4, 1, 2, 4.
int channels_of(BlockFormat format);

/// Blocks that cover a picture: sides over 4, rounded up.
Size blocks_of(Size size);
/// The sides as multiples of 4 that these blocks have.
Size whole_blocks(Size size);
/// Bytes of a picture's blocks.
std::size_t bytes_of(BlockFormat format, Size size);

}  // namespace weft::exchange
