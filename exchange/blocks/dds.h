// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "exchange/blocks/block_format.h"

// DirectDraw Surface: a header of 128 or 148 bytes, then the blocks of each level from the largest down
// (Microsoft, "Programming Guide for DDS", "DDS_HEADER_DXT10").

namespace weft::exchange {

/// A two-dimensional texture of blocks.
struct DdsTexture {
  BlockFormat format = BlockFormat::kBc7;
  bool is_srgb = false;             ///< said by DX10 headers alone; bc4 and bc5 are never
  bool is_dx10 = true;              ///< else a FourCC: DXT1, DXT5, ATI1, ATI2. bc7 has no FourCC
  Size size;                        ///< of levels[0]; 65536 a side at most. Direct3D wants multiples of 4
  std::vector<std::string> levels;  ///< one to level_count(size), bytes_of(format, level_size(size, i)) each
};

/// Width and height of a level: halves, rounded down, never below 1.
Size level_size(Size size, int level);
/// Levels down to 1 x 1, the first counted.
int level_count(Size size);
/// As most readers take it: a FourCC for bc1 and bc3, DX10 for the others.
bool is_dx10_by_default(BlockFormat format);

/// The file. kUsage where the texture does not hold what its comments say.
Result<std::string> dds_file(const DdsTexture& texture);

/// The strict reader: accepts what dds_file() writes and the like of other programs, and nothing that a
/// reader could take in two ways. kBadData with the field: another magic, a header cut short, sizes and flags
/// that contradict each other, a format that is not one of ours, a cube, a volume or an array, more levels
/// than the size has, bytes that are missing or left over. `where` is the file's name for the message.
Result<DdsTexture> parse_dds(std::string_view bytes, const std::string& where);

}  // namespace weft::exchange
