// SPDX-License-Identifier: Apache-2.0
#include "exchange/blocks/decode_blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <utility>

#include "core/base/parallel.h"

namespace weft::exchange {
namespace {

using Texel = std::array<float, 4>;
using Texels = std::array<Texel, 16>;

/// The first byte is the least.
std::uint64_t number_at(const std::uint8_t* bytes, int count) {
  std::uint64_t value = 0;
  for (int i = count; i-- > 0;) value = value << 8 | bytes[i];
  return value;
}

Texel color_of_565(std::uint64_t bits) {
  return {static_cast<float>(bits >> 11) / 31, static_cast<float>(bits >> 5 & 63) / 63,
          static_cast<float>(bits & 31) / 31, 1};
}

Texel between(const Texel& a, const Texel& b, int of_b, int steps) {
  Texel mixed = {};
  for (std::size_t c = 0; c < 4; ++c) {
    mixed[c] = (static_cast<float>(steps - of_b) * a[c] + static_cast<float>(of_b) * b[c]) /
               static_cast<float>(steps);
  }
  return mixed;
}

void decode_color(const std::uint8_t* block, bool has_three_steps, Texels& texels) {
  const std::uint64_t first = number_at(block, 2), second = number_at(block + 2, 2);
  const Texel a = color_of_565(first), b = color_of_565(second);
  const bool is_three = has_three_steps && first <= second;
  const std::array<Texel, 4> steps = {a, b, is_three ? between(a, b, 1, 2) : between(a, b, 1, 3),
                                      is_three ? Texel{0, 0, 0, 0} : between(a, b, 2, 3)};
  const std::uint64_t codes = number_at(block + 4, 4);
  for (std::size_t i = 0; i < 16; ++i) {
    for (std::size_t c = 0; c < 3; ++c) texels[i][c] = steps[codes >> (2 * i) & 3][c];
  }
}

void decode_channel(const std::uint8_t* block, std::size_t channel, Texels& texels) {
  const auto a = static_cast<float>(block[0]), b = static_cast<float>(block[1]);
  const bool is_eight = block[0] > block[1];
  const int last = is_eight ? 7 : 5;
  std::array<float, 8> steps = {a, b, 0, 0, 0, 0, 0, 255};
  for (int i = 1; i < last; ++i) {
    steps[static_cast<std::size_t>(i) + 1] =
        (static_cast<float>(last - i) * a + static_cast<float>(i) * b) / static_cast<float>(last);
  }
  const std::uint64_t codes = number_at(block + 2, 6);
  for (std::size_t i = 0; i < 16; ++i) texels[i][channel] = steps[codes >> (3 * i) & 7] / 255;
}

class BitReader {
 public:
  explicit BitReader(const std::uint8_t* bytes) : bytes_(bytes) {}
  unsigned take(int bits) {
    unsigned value = 0;
    for (int i = 0; i < bits; ++i, ++at_) value |= (unsigned{bytes_[at_ / 8]} >> (at_ % 8) & 1U) << i;
    return value;
  }

 private:
  const std::uint8_t* bytes_;
  int at_ = 0;
};

// Whether the block is of mode 6.
bool decode_mode_6(const std::uint8_t* block, Texels& texels) {
  constexpr std::array<unsigned, 16> kWeights = {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};
  BitReader bits(block);
  if (bits.take(7) != 64) return false;
  std::array<std::array<unsigned, 4>, 2> ends = {};
  for (std::size_t c = 0; c < 4; ++c) {
    for (auto& end : ends) end[c] = bits.take(7) << 1;
  }
  for (auto& end : ends) {
    const unsigned low = bits.take(1);
    for (unsigned& value : end) value |= low;
  }
  for (std::size_t i = 0; i < 16; ++i) {
    const unsigned weight = kWeights[bits.take(i == 0 ? 3 : 4)];
    for (std::size_t c = 0; c < 4; ++c) {
      const unsigned value = ((64 - weight) * ends[0][c] + weight * ends[1][c] + 32) >> 6;
      texels[i][c] = static_cast<float>(value) / 255;
    }
  }
  return true;
}

bool decode_block(BlockFormat format, const std::uint8_t* block, Texels& texels) {
  switch (format) {
    case BlockFormat::kBc1:
      decode_color(block, true, texels);
      return true;
    case BlockFormat::kBc3:
      decode_channel(block, 3, texels);
      decode_color(block + 8, false, texels);
      return true;
    case BlockFormat::kBc4:
      decode_channel(block, 0, texels);
      return true;
    case BlockFormat::kBc5:
      decode_channel(block, 0, texels);
      decode_channel(block + 8, 1, texels);
      return true;
    case BlockFormat::kBc7:
      break;
  }
  return decode_mode_6(block, texels);
}

void place(const Texels& texels, int x0, int y0, Image<float>& image) {
  const int columns = std::min(4, image.width() - x0), rows = std::min(4, image.height() - y0);
  for (int p = 0; p < image.planes(); ++p) {
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < columns; ++x) {
        image(x0 + x, y0 + y, p) = texels[static_cast<std::size_t>(4 * y + x)][static_cast<std::size_t>(p)];
      }
    }
  }
}

}  // namespace

Result<Image<float>> decode_blocks(BlockFormat format, std::string_view blocks, Size size, int threads) {
  if (size.width < 1 || size.height < 1) {
    return Error{ErrorKind::kUsage, "a picture without pixels", name_of(format), "", "give its sides"};
  }
  if (const std::size_t bytes = bytes_of(format, size); blocks.size() != bytes) {
    return Error{
        ErrorKind::kBadData, "wrong number of bytes", name_of(format),
        fmt::format("{} for {} x {} texels, which have {}", blocks.size(), size.width, size.height, bytes),
        "write the texture again"};
  }
  Image<float> image(size, channels_of(format));
  const Size count = blocks_of(size);
  std::atomic<bool> is_known = true;
  parallel_for(static_cast<std::size_t>(count.height), threads, [&](std::size_t row, int) {
    const std::size_t step = block_bytes(format);
    const auto* block = reinterpret_cast<const std::uint8_t*>(blocks.data()) +
                        row * static_cast<std::size_t>(count.width) * step;
    for (int x = 0; x < count.width; ++x, block += step) {
      Texels texels = {};
      if (!decode_block(format, block, texels)) is_known = false;
      place(texels, 4 * x, 4 * static_cast<int>(row), image);
    }
  });
  if (!is_known) {
    return Error{ErrorKind::kBadData, "a block of a mode that is not read", name_of(format),
                 "weft writes mode 6 and reads no other", "look at it with another program"};
  }
  return image;
}

}  // namespace weft::exchange
