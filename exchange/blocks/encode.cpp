// SPDX-License-Identifier: Apache-2.0
#include "exchange/blocks/encode.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "core/base/parallel.h"
#include "exchange/blocks/strip.h"

namespace weft::exchange {
namespace {

// No number is 0.
float texel_of(float value) {
  return value > 0 ? 255 * std::min(value, 1.0F) : 0.0F;
}

bool takes(BlockFormat format, std::size_t planes) {
  if (format == BlockFormat::kBc7 && planes == 3) return true;
  return planes == static_cast<std::size_t>(channels_of(format));
}

Result<void> check_planes(BlockFormat format, std::span<const View<const float>> planes) {
  const auto refused = [&](std::string why) {
    return Error{ErrorKind::kUsage, "these planes cannot become blocks", name_of(format), std::move(why),
                 "give planes of one size, as many as the format has channels"};
  };
  if (!takes(format, planes.size())) {
    return refused(fmt::format("{} planes for {} channels", planes.size(), channels_of(format)));
  }
  const Size size = planes[0].size();
  if (size.width < 1 || size.height < 1) return refused("there are no pixels");
  for (const auto& plane : planes) {
    if (plane.size() != size) {
      return refused(fmt::format("{} x {} pixels beside {} x {}", plane.width(), plane.height(), size.width,
                                 size.height));
    }
  }
  return {};
}

void encode_strip(BlockFormat format, const StripRows& strip, int planes, std::uint8_t* blocks) {
  const std::size_t step = block_bytes(format);
  switch (format) {
    case BlockFormat::kBc1:
      return encode_bc1(strip, true, blocks, step);
    case BlockFormat::kBc3:
      encode_bc4(strip, 3, blocks, step);
      return encode_bc1(strip, false, blocks + 8, step);
    case BlockFormat::kBc4:
      return encode_bc4(strip, 0, blocks, step);
    case BlockFormat::kBc5:
      encode_bc4(strip, 0, blocks, step);
      return encode_bc4(strip, 1, blocks + 8, step);
    case BlockFormat::kBc7:
      return encode_bc7(strip, planes, blocks);
  }
}

}  // namespace

Strip::Strip(int planes, Size size)
    : stride_((static_cast<std::size_t>(size.width) + kRowGroup - 1) / kRowGroup * kRowGroup),
      data_(stride_ * 4 * static_cast<std::size_t>(planes)) {}

StripRows Strip::take(std::span<const View<const float>> planes, int block_row) {
  StripRows strip;
  strip.blocks = static_cast<std::size_t>(blocks_of(planes[0].size()).width);
  for (std::size_t c = 0; c < planes.size(); ++c) {
    const auto width = static_cast<std::size_t>(planes[c].width());
    for (std::size_t y = 0; y < 4; ++y) {
      float* to = data_.data() + (4 * c + y) * stride_;
      const float* from =
          planes[c].row(std::min(4 * block_row + static_cast<int>(y), planes[c].height() - 1));
      for (std::size_t x = 0; x < width; ++x) to[x] = texel_of(from[x]);
      std::fill(to + width, to + stride_, to[width - 1]);
      strip.rows[c][y] = to;
    }
  }
  return strip;
}

Result<std::string> encode_blocks(BlockFormat format, std::span<const View<const float>> planes,
                                  int threads) {
  if (const auto good = check_planes(format, planes); !good) return good.error();
  const Size size = planes[0].size();
  const Size blocks = blocks_of(size);
  const auto count = static_cast<int>(planes.size());
  std::string bytes(bytes_of(format, size), '\0');
  const std::size_t row_bytes = static_cast<std::size_t>(blocks.width) * block_bytes(format);
  std::vector<std::unique_ptr<Strip>> strips(static_cast<std::size_t>(resolved_threads(threads)));
  parallel_for(static_cast<std::size_t>(blocks.height), threads, [&](std::size_t row, int worker) {
    std::unique_ptr<Strip>& strip = strips[static_cast<std::size_t>(worker)];
    if (!strip) strip = std::make_unique<Strip>(count, size);
    encode_strip(format, strip->take(planes, static_cast<int>(row)), count,
                 reinterpret_cast<std::uint8_t*>(bytes.data()) + row * row_bytes);
  });
  return bytes;
}

Image<float> padded_to_whole_blocks(std::span<const View<const float>> planes) {
  const Size size = planes[0].size();
  Image<float> padded(whole_blocks(size), static_cast<int>(planes.size()));
  for (int p = 0; p < padded.planes(); ++p) {
    for (int y = 0; y < padded.height(); ++y) {
      const float* from = planes[static_cast<std::size_t>(p)].row(std::min(y, size.height - 1));
      float* to = padded.plane(p).row(y);
      std::copy(from, from + size.width, to);
      std::fill(to + size.width, to + padded.width(), from[size.width - 1]);
    }
  }
  return padded;
}

}  // namespace weft::exchange
