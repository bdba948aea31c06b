// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace weft {

/// How values of albedo are to be taken.
enum class AlbedoScale {
  kRelative,  ///< they lack one common factor
  kAbsolute,  ///< a patch of measured reflectance fixed that factor
};

/// As documents have them.
inline constexpr std::array<const char*, 2> kAlbedoScaleNames = {"relative", "absolute"};

constexpr const char* name_of(AlbedoScale scale) {
  return kAlbedoScaleNames[static_cast<std::size_t>(scale)];
}

}  // namespace weft
