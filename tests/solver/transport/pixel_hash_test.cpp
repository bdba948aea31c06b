// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/pixel_hash.h"

#include <gtest/gtest.h>

namespace weft::solver {
namespace {

TEST(PixelHash, OfPixelsThatTouchHasNothingInCommon) {
  double along = 0, down = 0, first = 0;
  constexpr int kSide = 200;
  const auto unit = [](std::uint32_t bits) { return bits * 0x1p-32 - 0.5; };
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const PixelHash here = hash_of(x, y);
      along += 12 * unit(here.first) * unit(hash_of(x + 1, y).first) / (kSide * kSide);
      down += 12 * unit(here.second) * unit(hash_of(x, y + 1).second) / (kSide * kSide);
      first += 12 * unit(here.first) * unit(here.second) / (kSide * kSide);
    }
  }
  for (const double correlation : {along, down, first}) EXPECT_NEAR(correlation, 0, 0.02);
}

}  // namespace
}  // namespace weft::solver
