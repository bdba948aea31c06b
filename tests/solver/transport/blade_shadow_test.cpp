// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/blade_shadow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace weft::solver {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kBladeCell_mm = 0.08;
constexpr Size kBladePicture = {320, 240};

struct BladedCloth {
  double share = 0.3, mean_mm = 0.3;
  double blur_mm = 0.06;
  double floor = 0.01;     // light in the depth of the shadow
  double wave_mm = 0;      // by which yarns bend the shadow's edge
  double normal_deg = 20;  // of the edge, to the lit side
  double blade_mm = 2.6;   // from the shadow's edge to the blade
  double of_blade = 0.08;  // its brightness over the cloth's
  bool has_blade = true;
};

// The light at `d` from the edge: the penumbra that a Gaussian makes of it, spread by an exponential to both
// sides, which is summed in small steps.
double light_at(const BladedCloth& cloth, double d) {
  const auto penumbra = [&](double at) {
    return 0.5 * std::erfc(-at / (cloth.blur_mm * std::numbers::sqrt2));
  };
  const double length = 2 * cloth.mean_mm / kHalfTurn, step = length / 40;
  double spread = 0, weight = 0;
  for (double u = -12 * length; u <= 12 * length; u += step) {
    const double w = std::exp(-std::abs(u) / length);
    spread += w * penumbra(d - u), weight += w;
  }
  const double light = (1 - cloth.share) * penumbra(d) + cloth.share * spread / weight;
  return cloth.floor + (1 - cloth.floor) * light;
}

BladeCells blade_cells_of(const BladedCloth& cloth) {
  constexpr double kFar_mm = 25, kStep_mm = 0.005;
  std::vector<double> light;
  for (double d = -kFar_mm; d <= kFar_mm; d += kStep_mm)
    light.push_back(std::abs(d) < 8 ? light_at(cloth, d) : d > 0 ? 1 : cloth.floor);
  const auto lit_at = [&](double d) {
    const double at = (d + kFar_mm) / kStep_mm;
    const auto i = static_cast<std::size_t>(at);
    return light[i] + (at - std::floor(at)) * (light[i + 1] - light[i]);
  };
  BladeCells cells;
  cells.plain = Image<float>(kBladePicture);
  cells.bladed = Image<float>(kBladePicture);
  cells.cell_mm = kBladeCell_mm;
  const double nx = std::cos(cloth.normal_deg * kHalfTurn / 180),
               ny = std::sin(cloth.normal_deg * kHalfTurn / 180);
  cells.away_x = 1, cells.away_y = 0;
  std::mt19937 random(7);
  std::normal_distribution<double> grain(0, 0.003);
  for (int y = 0; y < kBladePicture.height; ++y) {
    for (int x = 0; x < kBladePicture.width; ++x) {
      const double u = kBladeCell_mm * (x - 0.55 * kBladePicture.width),
                   v = kBladeCell_mm * (y - 0.5 * kBladePicture.height);
      const double yarn = std::sin(2 * kHalfTurn * u / 0.45) * std::sin(2 * kHalfTurn * v / 0.5);
      const double plain = 0.4 * (1 + 0.3 * yarn);
      const double d = nx * u + ny * v;
      const bool is_blade = cloth.has_blade && d < -cloth.blade_mm && d > -cloth.blade_mm - 6;
      const double lit = !cloth.has_blade          ? 1
                         : d < -cloth.blade_mm - 6 ? 1
                                                   : lit_at(d + cloth.wave_mm * yarn);
      cells.plain(x, y) = static_cast<float>(plain * (1 + grain(random)));
      cells.bladed(x, y) =
          static_cast<float>((is_blade ? cloth.of_blade * 0.4 : plain * lit) + 0.4 * grain(random));
    }
  }
  return cells;
}

TEST(BladeShadow, TellsShareAndDistanceOfLightThatSpreads) {
  for (const auto& [share, mean_mm] : {std::pair(0.3, 0.3), std::pair(0.15, 0.5), std::pair(0.5, 0.8)}) {
    for (const double normal_deg : {-35.0, 0.0, 20.0}) {
      BladedCloth cloth;
      cloth.share = share, cloth.mean_mm = mean_mm, cloth.normal_deg = normal_deg;
      const Result<BladeShadow> shadow = read_blade_shadow(blade_cells_of(cloth));
      ASSERT_TRUE(shadow) << shadow.error().message();
      EXPECT_TRUE(shadow->tells());
      EXPECT_NEAR(shadow->spread.share, share, 0.015)
          << share << " over " << mean_mm << " mm at " << normal_deg << ": +- " << shadow->share_sigma;
      EXPECT_NEAR(shadow->spread.mean_mm, mean_mm, 0.03)
          << share << " over " << mean_mm << " mm at " << normal_deg << ": +- " << shadow->mean_sigma_mm;
      EXPECT_LT(shadow->share_sigma, 0.3 * share);
      EXPECT_LT(shadow->mean_sigma_mm, 0.2 * mean_mm);
      EXPECT_NEAR(shadow->blur_mm, cloth.blur_mm, 0.02);
      EXPECT_NEAR(shadow->floor, cloth.floor, 0.01);
    }
  }
}

TEST(BladeShadow, YarnsThatBendItsEdgeAreBlurAndNoShare) {
  BladedCloth cloth;
  cloth.wave_mm = 0.06;
  const Result<BladeShadow> shadow = read_blade_shadow(blade_cells_of(cloth));
  ASSERT_TRUE(shadow) << shadow.error().message();
  EXPECT_NEAR(shadow->spread.share, cloth.share, 0.02) << "+- " << shadow->share_sigma;
  EXPECT_NEAR(shadow->spread.mean_mm, cloth.mean_mm, 0.03) << "+- " << shadow->mean_sigma_mm;
}

TEST(BladeShadow, TellsNothingOfClothThatSpreadsNoLight) {
  BladedCloth cloth;
  cloth.share = 0;
  const Result<BladeShadow> shadow = read_blade_shadow(blade_cells_of(cloth));
  ASSERT_TRUE(shadow) << shadow.error().message();
  EXPECT_FALSE(shadow->tells()) << shadow->spread.share << " +- " << shadow->share_sigma << " over "
                                << shadow->spread.mean_mm << " mm";
}

TEST(BladeShadow, TellsNothingWhereTheBladeHidesIt) {
  BladedCloth cloth;
  cloth.blade_mm = 0, cloth.of_blade = 0.04;
  const Result<BladeShadow> shadow = read_blade_shadow(blade_cells_of(cloth));
  EXPECT_FALSE(shadow && shadow->tells()) << shadow->spread.share << " +- " << shadow->share_sigma;
}

TEST(BladeShadow, IsRefusedWhereNoStraightShadowCrossesTheCloth) {
  BladedCloth bare;
  bare.has_blade = false;
  const Result<BladeShadow> none = read_blade_shadow(blade_cells_of(bare));
  ASSERT_FALSE(none) << "a picture without a blade gave " << none->spread.share;
  EXPECT_EQ(none.error().kind, ErrorKind::kBadData);

  // A coin instead of a blade: its shadow has no straight edge.
  BladeCells coin = blade_cells_of(bare);
  for (int y = 0; y < kBladePicture.height; ++y) {
    for (int x = 0; x < kBladePicture.width; ++x) {
      if (std::hypot(x - 160, y - 120) < 60) coin.bladed(x, y) = 0;
    }
  }
  const Result<BladeShadow> round = read_blade_shadow(coin);
  EXPECT_FALSE(round) << "a coin gave " << round->spread.share << " +- " << round->share_sigma;
}

TEST(BladeShadow, DoesNotMindMissingCells) {
  BladeCells cells = blade_cells_of({});
  for (int y = 0; y < kBladePicture.height; ++y) {
    for (int x = 0; x < kBladePicture.width; ++x) {
      if ((x / 20 + y / 20) % 5 == 0) cells.plain(x, y) = std::numeric_limits<float>::quiet_NaN();
    }
  }
  const Result<BladeShadow> shadow = read_blade_shadow(cells);
  ASSERT_TRUE(shadow) << shadow.error().message();
  EXPECT_NEAR(shadow->spread.share, 0.3, 0.02) << "+- " << shadow->share_sigma;
}

}  // namespace
}  // namespace weft::solver
