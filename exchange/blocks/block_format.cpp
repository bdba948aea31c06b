// SPDX-License-Identifier: Apache-2.0
#include "exchange/blocks/block_format.h"

#include <algorithm>

namespace weft::exchange {
namespace {

struct BlockFacts {
  const char* name;
  std::size_t bytes;
  int channels;
};

BlockFacts facts_of(BlockFormat format) {
  switch (format) {
    case BlockFormat::kBc1:
      return {"bc1", 8, 3};
    case BlockFormat::kBc3:
      return {"bc3", 16, 4};
    case BlockFormat::kBc4:
      return {"bc4", 8, 1};
    case BlockFormat::kBc5:
      return {"bc5", 16, 2};
    case BlockFormat::kBc7:
      break;
  }
  return {"bc7", 16, 4};
}

}  // namespace

const char* name_of(BlockFormat format) {
  return facts_of(format).name;
}

std::optional<BlockFormat> block_format_named(std::string_view name) {
  const auto found =
      std::ranges::find_if(kBlockFormats, [&](BlockFormat format) { return name == name_of(format); });
  return found == kBlockFormats.end() ? std::nullopt : std::optional(*found);
}

std::size_t block_bytes(BlockFormat format) {
  return facts_of(format).bytes;
}

int channels_of(BlockFormat format) {
  return facts_of(format).channels;
}

Size blocks_of(Size size) {
  return {(size.width + 3) / 4, (size.height + 3) / 4};
}

Size whole_blocks(Size size) {
  const Size blocks = blocks_of(size);
  return {4 * blocks.width, 4 * blocks.height};
}

std::size_t bytes_of(BlockFormat format, Size size) {
  return static_cast<std::size_t>(blocks_of(size).pixels()) * block_bytes(format);
}

}  // namespace weft::exchange
