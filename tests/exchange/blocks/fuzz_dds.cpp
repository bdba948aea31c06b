// SPDX-License-Identifier: Apache-2.0
// libFuzzer program: any bytes as a DDS file. What is read can be written and is then read as the same.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "exchange/blocks/dds.h"
#include "exchange/blocks/decode_blocks.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace weft::exchange;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto texture = parse_dds(bytes, "");
  if (!texture) return 0;
  const auto file = dds_file(*texture);
  if (!file || file->size() != size) std::abort();
  const auto again = parse_dds(*file, "");
  if (!again || again->levels != texture->levels || again->is_srgb != texture->is_srgb) std::abort();
  for (std::size_t i = 0; i < texture->levels.size(); ++i) {
    const auto level = level_size(texture->size, static_cast<int>(i));
    const auto image = decode_blocks(texture->format, texture->levels[i], level, 1);
    if (!image && texture->format != BlockFormat::kBc7) std::abort();
  }
  return 0;
}
