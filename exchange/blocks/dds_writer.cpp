// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "exchange/blocks/dds.h"
#include "exchange/blocks/dds_fields.h"

namespace weft::exchange {
namespace {

Error cannot_hold(const DdsTexture& texture, std::string what, std::string why) {
  return {ErrorKind::kUsage, "a DDS file cannot hold this",
          std::string(name_of(texture.format)) + ", " + what, std::move(why),
          "give a texture that it can hold"};
}

const DdsName& dds_name(BlockFormat format) {
  return *std::ranges::find(kDdsNames, format, &DdsName::format);
}

Result<void> check_name(const DdsTexture& texture) {
  const DdsName& name = dds_name(texture.format);
  if (!texture.is_dx10 && name.four_cc.empty()) return cannot_hold(texture, "FourCC", "the format has none");
  if (!texture.is_dx10 && texture.is_srgb) {
    return cannot_hold(texture, "sRGB", "a FourCC does not say how colour is encoded");
  }
  if (texture.is_srgb && name.dxgi_srgb == 0) return cannot_hold(texture, "sRGB", "the format holds data");
  return {};
}

Result<void> check_levels(const DdsTexture& texture) {
  const auto [width, height] = texture.size;
  if (std::min(width, height) < 1 || std::max(width, height) > kMostDdsSide) {
    return cannot_hold(texture, "size", fmt::format("{} x {}", width, height));
  }
  const auto most = static_cast<std::size_t>(level_count(texture.size));
  if (texture.levels.empty() || texture.levels.size() > most) {
    return cannot_hold(texture, "levels", fmt::format("{} of at most {}", texture.levels.size(), most));
  }
  for (std::size_t i = 0; i < texture.levels.size(); ++i) {
    const std::size_t bytes = bytes_of(texture.format, level_size(texture.size, static_cast<int>(i)));
    if (texture.levels[i].size() != bytes) {
      return cannot_hold(texture, fmt::format("level {}", i),
                         fmt::format("{} bytes instead of {}", texture.levels[i].size(), bytes));
    }
  }
  return {};
}

void put(std::string& header, std::size_t offset, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) header[offset + i] = static_cast<char>(value >> (8 * i) & 255U);
}

std::string header_of(const DdsTexture& texture) {
  using At = DdsOffset;
  const DdsName& name = dds_name(texture.format);
  const bool has_levels = texture.levels.size() > 1;
  std::string header(kDdsHeaderBytes + (texture.is_dx10 ? kDdsDx10Bytes : 0), '\0');
  header.replace(0, 4, "DDS ");
  put(header, At::kSize, 124);
  put(header, At::kFlags, DdsFlag::kRequired | DdsFlag::kLinearSize | (has_levels ? DdsFlag::kLevels : 0));
  put(header, At::kHeight, static_cast<std::uint32_t>(texture.size.height));
  put(header, At::kWidth, static_cast<std::uint32_t>(texture.size.width));
  put(header, At::kLinearSize, static_cast<std::uint32_t>(texture.levels[0].size()));
  put(header, At::kLevels, static_cast<std::uint32_t>(texture.levels.size()));
  put(header, At::kPixelSize, 32);
  put(header, At::kPixelFlags, kDdsHasFourCc);
  header.replace(At::kFourCc, 4, texture.is_dx10 ? "DX10" : name.four_cc);
  put(header, At::kCaps, kDdsIsTexture | (has_levels ? kDdsHasLevels : 0));
  if (!texture.is_dx10) return header;
  put(header, At::kDxgi, texture.is_srgb ? name.dxgi_srgb : name.dxgi);
  put(header, At::kDimension, kDdsTwoDimensions);
  put(header, At::kArray, 1);
  return header;
}

}  // namespace

Size level_size(Size size, int level) {
  return {std::max(1, size.width >> level), std::max(1, size.height >> level)};
}

int level_count(Size size) {
  return static_cast<int>(std::bit_width(static_cast<unsigned>(std::max({size.width, size.height, 1}))));
}

bool is_dx10_by_default(BlockFormat format) {
  return format != BlockFormat::kBc1 && format != BlockFormat::kBc3;
}

Result<std::string> dds_file(const DdsTexture& texture) {
  if (const auto good = check_name(texture); !good) return good.error();
  if (const auto good = check_levels(texture); !good) return good.error();
  std::string file = header_of(texture);
  std::size_t bytes = file.size();
  for (const std::string& level : texture.levels) bytes += level.size();
  file.reserve(bytes);
  for (const std::string& level : texture.levels) file += level;
  return file;
}

}  // namespace weft::exchange
