// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace weft {

/// How samples are packed in an image file, always without loss. EXR has all of them, TIFF no kPiz; PNG is
/// deflated whatever is asked for.
enum class Compression { kNone, kZip, kPiz };

/// As the command line and documents have them.
inline constexpr std::array<const char*, 3> kCompressionNames = {"none", "zip", "piz"};

constexpr const char* name_of(Compression compression) {
  return kCompressionNames[static_cast<std::size_t>(compression)];
}

}  // namespace weft
