// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "exchange/blocks/block_format.h"

// Numbers of a DDS file (Microsoft, "DDS_HEADER", "DXGI_FORMAT").

namespace weft::exchange {

inline constexpr std::size_t kDdsHeaderBytes = 128, kDdsDx10Bytes = 20;
inline constexpr int kMostDdsSide = 65536;

/// Offsets of 32-bit fields, least byte first.
struct DdsOffset {
  static constexpr std::size_t kSize = 4, kFlags = 8, kHeight = 12, kWidth = 16, kLinearSize = 20,
                               kDepth = 24, kLevels = 28, kPixelSize = 76, kPixelFlags = 80, kFourCc = 84,
                               kCaps = 108, kCaps2 = 112, kDxgi = 128, kDimension = 132, kMisc = 136,
                               kArray = 140, kAlpha = 144;
};

struct DdsFlag {
  static constexpr std::uint32_t kCaps = 0x1, kHeight = 0x2, kWidth = 0x4, kPixelFormat = 0x1000,
                                 kLevels = 0x20000, kLinearSize = 0x80000, kDepth = 0x800000;
  static constexpr std::uint32_t kRequired = kCaps | kHeight | kWidth | kPixelFormat;
};
inline constexpr std::uint32_t kDdsHasFourCc = 0x4;
inline constexpr std::uint32_t kDdsIsTexture = 0x1000, kDdsHasLevels = 0x400008;  // of caps
inline constexpr std::uint32_t kDdsTwoDimensions = 3;

/// How a format is called; 0 and "" where it has no such name.
struct DdsName {
  BlockFormat format;
  std::string_view four_cc, other_four_cc;
  std::uint32_t dxgi, dxgi_srgb;
};
inline constexpr std::array<DdsName, 5> kDdsNames = {{{BlockFormat::kBc1, "DXT1", "", 71, 72},
                                                      {BlockFormat::kBc3, "DXT5", "", 77, 78},
                                                      {BlockFormat::kBc4, "ATI1", "BC4U", 80, 0},
                                                      {BlockFormat::kBc5, "ATI2", "BC5U", 83, 0},
                                                      {BlockFormat::kBc7, "", "", 98, 99}}};

}  // namespace weft::exchange
