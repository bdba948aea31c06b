// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "exchange/blocks/dds.h"
#include "exchange/blocks/dds_fields.h"

namespace weft::exchange {
namespace {

class DdsReader {
 public:
  using At = DdsOffset;

  DdsReader(std::string_view bytes, const std::string& where) : bytes_(bytes), where_(where) {}

  Result<DdsTexture> read() {
    if (const auto good = check_header(); !good) return good.error();
    if (const auto good = read_format(); !good) return good.error();
    if (const auto good = check_kind(); !good) return good.error();
    if (const auto good = read_levels(); !good) return good.error();
    return std::move(texture_);
  }

 private:
  std::uint32_t at(std::size_t offset) const {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes_[offset + i]);
    return value;
  }
  Error broken(const char* field, std::string why) const {
    return {ErrorKind::kBadData, "not a DDS file that can be read", where_ + ", " + field, std::move(why),
            "export the texture again"};
  }

  Result<void> check_header() const {
    if (!bytes_.starts_with("DDS ")) return broken("magic", "the file does not begin with \"DDS \"");
    if (bytes_.size() < kDdsHeaderBytes) {
      return broken("header", fmt::format("{} bytes of {}", bytes_.size(), kDdsHeaderBytes));
    }
    if (at(At::kSize) != 124) return broken("size", fmt::format("{} instead of 124", at(At::kSize)));
    if (at(At::kPixelSize) != 32) {
      return broken("pixel format size", fmt::format("{} instead of 32", at(At::kPixelSize)));
    }
    if ((at(At::kFlags) & DdsFlag::kRequired) != DdsFlag::kRequired) {
      return broken("flags", fmt::format("{:#x} lacks some of {:#x}", at(At::kFlags), DdsFlag::kRequired));
    }
    if (at(At::kPixelFlags) != kDdsHasFourCc) {
      return broken("pixel format flags",
                    fmt::format("{:#x} instead of a FourCC alone", at(At::kPixelFlags)));
    }
    return {};
  }

  Result<void> read_format() {
    const std::string_view four_cc = bytes_.substr(At::kFourCc, 4);
    texture_.is_dx10 = four_cc == "DX10";
    if (texture_.is_dx10) return read_dx10();
    const auto found = std::ranges::find_if(kDdsNames, [&](const DdsName& name) {
      return four_cc == name.four_cc || four_cc == name.other_four_cc;
    });
    if (found == kDdsNames.end()) return broken("FourCC", "not DXT1, DXT5, ATI1, BC4U, ATI2, BC5U or DX10");
    texture_.format = found->format;
    first_byte_ = kDdsHeaderBytes;
    return {};
  }

  Result<void> read_dx10() {
    first_byte_ = kDdsHeaderBytes + kDdsDx10Bytes;
    if (bytes_.size() < first_byte_) {
      return broken("DX10 header", fmt::format("{} bytes of {}", bytes_.size(), first_byte_));
    }
    const std::uint32_t dxgi = at(At::kDxgi);
    const auto found = std::ranges::find_if(kDdsNames, [&](const DdsName& name) {
      return dxgi != 0 && (dxgi == name.dxgi || dxgi == name.dxgi_srgb);
    });
    if (found == kDdsNames.end()) {
      return broken("DXGI format",
                    fmt::format("{} is not BC1, BC3, BC4, BC5 or BC7 of unsigned values", dxgi));
    }
    texture_.format = found->format;
    texture_.is_srgb = dxgi == found->dxgi_srgb;
    if (at(At::kDimension) != kDdsTwoDimensions) {
      return broken("resource dimension", fmt::format("{} instead of 3", at(At::kDimension)));
    }
    if (at(At::kMisc) != 0) return broken("misc flag", fmt::format("{:#x}: a cube map", at(At::kMisc)));
    if (at(At::kArray) != 1) return broken("array size", fmt::format("{} instead of 1", at(At::kArray)));
    if (at(At::kAlpha) > 4) return broken("alpha mode", fmt::format("{} is above 4", at(At::kAlpha)));
    return {};
  }

  Result<void> check_kind() const {
    if ((at(At::kFlags) & DdsFlag::kDepth) != 0 || at(At::kDepth) > 1) return broken("depth", "a volume");
    if (at(At::kCaps2) != 0)
      return broken("caps2", fmt::format("{:#x}: a cube map or a volume", at(At::kCaps2)));
    if ((at(At::kCaps) & kDdsIsTexture) == 0) return broken("caps", "does not say that it is a texture");
    return {};
  }

  Result<void> read_levels() {
    const std::uint32_t width = at(At::kWidth), height = at(At::kHeight);
    if (std::min(width, height) < 1 || std::max(width, height) > kMostDdsSide) {
      return broken("width and height", fmt::format("{} x {}", width, height));
    }
    texture_.size = {static_cast<int>(width), static_cast<int>(height)};
    const std::uint32_t said = at(At::kLevels), count = std::max(said, 1U);
    if (count > 1 && (at(At::kFlags) & DdsFlag::kLevels) == 0) {
      return broken("flags", fmt::format("{} levels, and no flag for them", said));
    }
    if (count > static_cast<std::uint32_t>(level_count(texture_.size))) {
      return broken("mip map count", fmt::format("{} levels of {} x {}", said, width, height));
    }
    if (const auto good = check_linear_size(); !good) return good.error();
    std::size_t end = first_byte_;
    for (std::uint32_t i = 0; i < count; ++i) end += bytes_of_level(i);
    if (bytes_.size() != end) {
      return broken("length", fmt::format("{} bytes where the header asks for {}", bytes_.size(), end));
    }
    std::size_t begin = first_byte_;
    for (std::uint32_t i = 0; i < count; ++i) {
      texture_.levels.emplace_back(bytes_.substr(begin, bytes_of_level(i)));
      begin += bytes_of_level(i);
    }
    return {};
  }

  // Some writers leave it 0.
  Result<void> check_linear_size() const {
    const std::size_t said = at(At::kLinearSize);
    if ((at(At::kFlags) & DdsFlag::kLinearSize) == 0 || said == 0) return {};
    if (said != bytes_of_level(0)) {
      return broken("linear size", fmt::format("{} instead of {}", said, bytes_of_level(0)));
    }
    return {};
  }
  std::size_t bytes_of_level(std::uint32_t i) const {
    return bytes_of(texture_.format, level_size(texture_.size, static_cast<int>(i)));
  }

  std::string_view bytes_;
  const std::string& where_;
  std::size_t first_byte_ = 0;
  DdsTexture texture_;
};

}  // namespace

Result<DdsTexture> parse_dds(std::string_view bytes, const std::string& where) {
  return DdsReader(bytes, where).read();
}

}  // namespace weft::exchange
