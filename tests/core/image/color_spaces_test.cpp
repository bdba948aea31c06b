// SPDX-License-Identifier: Apache-2.0
#include "core/image/color_spaces.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft {
namespace {

struct Pair {
  Lab first, second;
  double distance;
};

// Sharma, Wu and Dalal 2005, table 1.
constexpr std::array<Pair, 34> kPublished = {
    {{{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
     {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
     {{50, 2.8361, -74.0200}, {50, 0, -82.7485}, 3.4412},
     {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
     {{50, -1.1848, -84.8006}, {50, 0, -82.7485}, 1.0000},
     {{50, -0.9009, -85.5211}, {50, 0, -82.7485}, 1.0000},
     {{50, 0, 0}, {50, -1, 2}, 2.3669},
     {{50, -1, 2}, {50, 0, 0}, 2.3669},
     {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0009}, 7.1792},
     {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0010}, 7.1792},
     {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0011}, 7.2195},
     {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0012}, 7.2195},
     {{50, -0.0010, 2.4900}, {50, 0.0009, -2.4900}, 4.8045},
     {{50, -0.0010, 2.4900}, {50, 0.0010, -2.4900}, 4.8045},
     {{50, -0.0010, 2.4900}, {50, 0.0011, -2.4900}, 4.7461},
     {{50, 2.5, 0}, {50, 0, -2.5}, 4.3065},
     {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
     {{50, 2.5, 0}, {61, -5, 29}, 22.8977},
     {{50, 2.5, 0}, {56, -27, -3}, 31.9030},
     {{50, 2.5, 0}, {58, 24, 15}, 19.4535},
     {{50, 2.5, 0}, {50, 3.1736, 0.5854}, 1.0000},
     {{50, 2.5, 0}, {50, 3.2972, 0}, 1.0000},
     {{50, 2.5, 0}, {50, 1.8634, 0.5757}, 1.0000},
     {{50, 2.5, 0}, {50, 3.2592, 0.3350}, 1.0000},
     {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
     {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
     {{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
     {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
     {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
     {{36.4612, 47.8580, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
     {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
     {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
     {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
     {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082}}};

TEST(Ciede2000, AgreesWithTheThirtyFourPublishedPairs) {
  for (std::size_t i = 0; i < kPublished.size(); ++i) {
    const auto& [first, second, distance] = kPublished[i];
    EXPECT_NEAR(ciede2000(first, second), distance, 5e-5) << "pair " << i + 1;
    EXPECT_NEAR(ciede2000(second, first), distance, 5e-5) << "pair " << i + 1 << ", turned round";
  }
}

TEST(Ciede2000, IsNothingForTheSameColour) {
  for (const Pair& pair : kPublished) EXPECT_EQ(ciede2000(pair.first, pair.first), 0);
}

TEST(ColorSpaces, TurnColoursIntoEachOtherAndBack) {
  for (const Rgb& rgb : {Rgb{0.2, 0.5, 0.7}, Rgb{1, 1, 1}, Rgb{-0.03, 0.2, 0.3}, Rgb{0.001, 0.002, 0.0005}}) {
    const Xyz xyz = xyz_of_rec709(rgb);
    const Rgb back = rec709_of_xyz(xyz), by_xyy = rec709_of_xyz(xyz_of_xyy(xyy_of_xyz(xyz))),
              by_lab = rec709_of_xyz(xyz_of_lab(lab_of_xyz(xyz, kWhiteD65), kWhiteD65));
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(back[c], rgb[c], 2e-7);
      EXPECT_NEAR(by_xyy[c], rgb[c], 2e-7);
      EXPECT_NEAR(by_lab[c], rgb[c], 2e-7);
    }
  }
  const Rgb grey = rec709_of_srgb(srgb_of_rec709({0.18, 0.5, 0.0001}));
  EXPECT_NEAR(grey[0], 0.18, 1e-4);
  EXPECT_NEAR(grey[2], 0.0001, 1e-7);
}

TEST(ColorSpaces, HaveWhiteInItsPlace) {
  const Lab white = lab_of_rec709({1, 1, 1});
  EXPECT_NEAR(white.L, 100, 1e-3);
  EXPECT_NEAR(white.a, 0, 0.01);
  EXPECT_NEAR(white.b, 0, 0.01);
  for (const double v : rec709_of_lab_d50({100, 0, 0})) EXPECT_NEAR(v, 1, 1e-3);
  EXPECT_EQ(xyz_of_xyy(xyy_of_xyz({0, 0, 0})), (Xyz{0, 0, 0}));
  EXPECT_EQ(xyz_of_xyy({0.3, 0, 0.5}), (Xyz{0, 0, 0}));
}

}  // namespace
}  // namespace weft
