// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace weft::solver {

/// Two numbers from a pixel's coordinates, each bit as good as random (pcg2d of Jarzynski and Olano, JCGT
/// 9(3), 2020, listing "pcg2d").
struct PixelHash {
  std::uint32_t first, second;
};
inline PixelHash hash_of(int x, int y) {
  constexpr std::uint32_t kFactor = 1664525, kStep = 1013904223;
  std::uint32_t a = static_cast<std::uint32_t>(x) * kFactor + kStep;
  std::uint32_t b = static_cast<std::uint32_t>(y) * kFactor + kStep;
  for (int round = 0; round < 2; ++round) {
    a += b * kFactor;
    b += a * kFactor;
    a ^= a >> 16;
    b ^= b >> 16;
  }
  return {a, b};
}

}  // namespace weft::solver
