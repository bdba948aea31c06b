// SPDX-License-Identifier: Apache-2.0
#include "core/rig/veil.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace weft {
namespace {

constexpr Size kFrame = {300, 200};
constexpr float kFull = std::numeric_limits<float>::infinity();

VeilOverFrame veil_of(const Image<float>& seen, const Veil& veil) {
  return {veil, seen.size(), CfaPattern{}, [&](Rect rows, View<float> out) {
            for (int y = rows.y0; y < rows.y1; ++y) {
              for (int x = 0; x < rows.width(); ++x) out(x, y - rows.y0) = seen(x, y);
            }
          }};
}

// A white sheet with a black hole a fifth of the frame wide.
double sheet(int x, int y) {
  return std::abs(x - 150) < 30 && std::abs(y - 100) < 30 ? 0.0 : 1.0;
}

// What a lens with a veil makes of the sheet, pixel by pixel from its definition.
Image<float> seen_through(const Veil& veil) {
  const double sigma_px = veil.spread * std::hypot(kFrame.width, kFrame.height);
  constexpr int kStep = 10;
  Image<float> seen(kFrame);
  for (int y = 0; y < kFrame.height; ++y) {
    for (int x = 0; x < kFrame.width; ++x) {
      double light = 0, weight = 0;
      for (int v = kStep / 2; v < kFrame.height; v += kStep) {
        for (int u = kStep / 2; u < kFrame.width; u += kStep) {
          const double w = std::exp(-(std::pow(u - x, 2) + std::pow(v - y, 2)) / (2 * sigma_px * sigma_px));
          light += w * sheet(u, v);
          weight += w;
        }
      }
      seen(x, y) = static_cast<float>(sheet(x, y) + veil.share * light / weight);
    }
  }
  return seen;
}

TEST(Veil, EvenLightLosesItsShareEverywhere) {
  const Veil veil = {.share = 0.02};
  Image<float> seen(kFrame);
  for (int y = 0; y < kFrame.height; ++y) {
    for (int x = 0; x < kFrame.width; ++x) seen(x, y) = 1.02F;
  }
  veil_of(seen, veil).take_off({0, 0, kFrame.width, kFrame.height}, seen.plane());
  for (int y = 0; y < kFrame.height; ++y) {
    for (int x = 0; x < kFrame.width; ++x) ASSERT_NEAR(seen(x, y), 1, 1e-6) << x << ", " << y;
  }
}

TEST(Veil, AHoleInASheetIsBlackAgain) {
  for (const double spread : {0.3, 0.5, 3.0}) {
    const Veil veil = {.share = 0.02, .spread = spread};
    Image<float> seen = seen_through(veil);
    EXPECT_GT(seen(150, 100), 0.015F);
    veil_of(seen, veil).take_off({0, 0, kFrame.width, kFrame.height}, seen.plane());
    double worst = 0;
    for (int y = 0; y < kFrame.height; ++y) {
      for (int x = 0; x < kFrame.width; ++x) {
        worst = std::max(worst, std::abs(static_cast<double>(seen(x, y)) - sheet(x, y)));
      }
    }
    EXPECT_LT(worst, 0.02 * 0.02) << "spread " << spread << ": the square of the share";
  }
}

TEST(Veil, ATileHasTheBytesOfTheFrame) {
  const Veil veil = {.share = 0.05, .spread = 0.2};
  const Image<float> seen = seen_through(veil);
  const VeilOverFrame over = veil_of(seen, veil);
  Image<float> whole(kFrame);
  over.take_off({0, 0, kFrame.width, kFrame.height}, whole.plane());
  for (const Rect tile : {Rect{0, 0, 64, 7}, Rect{62, 31, 131, 90}, Rect{258, 190, 300, 200}}) {
    Image<float> part({tile.width(), tile.height()});
    over.take_off(tile, part.plane());
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x)
        ASSERT_EQ(part(x - tile.x0, y - tile.y0), whole(x, y)) << x << ", " << y;
    }
  }
}

TEST(Veil, FullAndMissingReadingsStayWhatTheyAre) {
  Image<float> seen(kFrame);
  for (int y = 0; y < kFrame.height; ++y) {
    for (int x = 0; x < kFrame.width; ++x) seen(x, y) = x < 100 ? kFull : x < 200 ? 1.01F : std::nanf("");
  }
  veil_of(seen, {.share = 0.01}).take_off({0, 0, kFrame.width, kFrame.height}, seen.plane());
  EXPECT_EQ(seen(50, 50), kFull);
  EXPECT_NEAR(seen(150, 50), 1, 1e-6) << "neither of them counts as light";
  EXPECT_TRUE(std::isnan(seen(250, 50)));
  Image<float> dark(kFrame);
  veil_of(dark, {.share = 0.01}).take_off({0, 0, kFrame.width, kFrame.height}, dark.plane());
  EXPECT_EQ(dark(10, 10), 0.0F);
}

}  // namespace
}  // namespace weft
