// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace weft {

/// How the values of a developed photograph follow light.
enum class Transfer {
  kAuto,    ///< as the file says; where it does not, 16-bit and float files are linear, 8-bit ones sRGB
  kLinear,  ///< proportional to light
  kSrgb,    ///< IEC 61966-2-1
};
/// As the command line and documents have them.
inline constexpr std::array<const char*, 3> kTransferNames = {"auto", "linear", "srgb"};
constexpr const char* name_of(Transfer transfer) {
  return kTransferNames[static_cast<std::size_t>(transfer)];
}

}  // namespace weft
