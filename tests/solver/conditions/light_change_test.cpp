// SPDX-License-Identifier: Apache-2.0
#include "solver/conditions/light_change.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bench/oracles/oracle_rig.h"

namespace weft::solver {
namespace {

constexpr float kFull = std::numeric_limits<float>::infinity();

TEST(LightRatio, OfTwoShotsIsFoundTo1e4UnderPhotonNoise) {
  // 40 x 40 blocks of 1024 readings of 4000 electrons with their photon noise: 0.0007 percent is possible.
  test::Random random(1);
  std::vector<BlockChange> blocks;
  const double ratio = 0.9873;
  for (int i = 0; i < 1600; ++i) {
    const double light = 1024 * 4000 * (0.2 + random.uniform());
    blocks.push_back({light + std::sqrt(light) * random.normal(),
                      ratio * light + std::sqrt(ratio * light) * random.normal()});
  }
  EXPECT_NEAR(light_ratio(blocks).value(), ratio, 1e-4);
}

TEST(LightRatio, IsNotMovedByAHandInATenthOfTheFrame) {
  std::vector<BlockChange> blocks(100, {1000, 980});
  for (std::size_t i = 0; i < 10; ++i) blocks[10 * i].later = 50;
  EXPECT_DOUBLE_EQ(light_ratio(blocks).value(), 0.98);
}

TEST(LightRatio, IsUnknownWithoutLight) {
  EXPECT_FALSE(light_ratio({}));
  EXPECT_FALSE(light_ratio({{1000, -2}, {0, 1000}}));
}

TEST(BlockLight, SumsOnlyReadingsThatBothShotsHave) {
  Image<float> earlier({4, 2}), later({4, 2});
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 2; ++y) earlier(x, y) = 2, later(x, y) = 1;
  }
  earlier(0, 0) = kFull;
  later(1, 0) = kFull;
  later(2, 1) = std::numeric_limits<float>::quiet_NaN();
  const BlockChange light = block_light(std::vector<View<const float>>{earlier.plane()},
                                        std::vector<View<const float>>{later.plane()});
  EXPECT_EQ(light.earlier, 10);
  EXPECT_EQ(light.later, 5);
}

TEST(DriftRate, IsTheSlopeThroughTheRepeats) {
  EXPECT_DOUBLE_EQ(drift_rate(std::vector<LightRepeat>{{0, 10, 0.98}}), -0.002);
  EXPECT_DOUBLE_EQ(drift_rate(std::vector<LightRepeat>{{0, 10, 0.98}, {5, 10, 0.99}}), -0.002);
  EXPECT_EQ(drift_rate({}), 0);
  EXPECT_EQ(drift_rate(std::vector<LightRepeat>{{3, 3, 0.9}}), 0) << "no time went by";
}

TEST(PatchLight, IsTheFactorOfItsLed) {
  const Size size = {128, 96};
  const LightField field =
      LightField::make(Lights(test::ten_leds()), overhead_camera(size, 600, 0.5), size, 0).value();
  const WhitePatch patch = {{{20.5, 30}, {60, 32.5}, {58, 70}, {22, 66}}, {0.8, 0.9, 0.7}};
  const Rect area = area_of(patch, size);
  EXPECT_EQ(area, (Rect{20, 30, 61, 71}));
  const CfaPattern cfa;
  Image<float> readings({area.width(), area.height()});
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      const int c = cfa.channel_at(x, y);
      const LightField::Light light = field.at(4, c, x, y);
      readings(x - area.x0, y - area.y0) = static_cast<float>(
          0.97 * patch.reflectance_rgb[static_cast<std::size_t>(c)] * light.strength * light.direction.z);
    }
  }
  readings(20, 20) = kFull;
  const PatchLight light =
      patch_light(patch, field, 4, area, std::vector<View<const float>>{readings.plane()}, cfa);
  EXPECT_NEAR(light.factor(), 0.97, 1e-6);
  EXPECT_NEAR(light.reading_rgb[2] / light.predicted_rgb[2], 0.97, 1e-6) << "of a channel alone";
  EXPECT_NEAR(static_cast<double>(light.used), 1400, 150) << "the quadrilateral's pixels, not its box's 1681";
  EXPECT_EQ(light.unusable, 1);
}

TEST(PatchLight, FallsOffAsThePaperDoes) {
  const Size size = {128, 96};
  const LightField field =
      LightField::make(Lights(test::ten_leds()), overhead_camera(size, 600, 0.5), size, 0).value();
  WhitePatch patch = {{{20, 30}, {30, 30}, {30, 40}, {20, 40}}, {0.8, 0.8, 0.8}};
  patch.delta = 0.05;
  const Rect area = area_of(patch, size);
  Image<float> readings({area.width(), area.height()}, 3);
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      for (int c = 0; c < 3; ++c) {
        const LightField::Light light = field.at(6, c, x, y);
        const double cosine = light.direction.z;
        readings(x - area.x0, y - area.y0, c) =
            static_cast<float>(0.8 * light.strength * cosine * (1 - 0.05 * (1 - cosine)));
      }
    }
  }
  const std::vector<View<const float>> planes = {readings.plane(0), readings.plane(1), readings.plane(2)};
  EXPECT_NEAR(patch_light(patch, field, 6, area, planes, {}).factor(), 1, 1e-6);
  patch.delta = 0;
  EXPECT_LT(patch_light(patch, field, 6, area, planes, {}).factor(), 0.98) << "62 degrees from the zenith";
}

TEST(WellInside, IsFourFifthsOfAPatchAboutItsMiddle) {
  const WhitePatch inside = well_inside({{{10, 20}, {30, 20}, {30, 40}, {10, 40}}});
  EXPECT_NEAR(inside.polygon_px[0][0], 12, 1e-9);
  EXPECT_NEAR(inside.polygon_px[2][1], 38, 1e-9);
}

TEST(PatchLight, OutsideTheFrameHasNoArea) {
  EXPECT_EQ(area_of({{{200, 10}, {220, 10}, {210, 30}}}, {128, 96}).pixels(), 0);
  EXPECT_EQ(area_of({{{-50, 10}, {-20, 10}, {-30, 30}}}, {128, 96}).pixels(), 0);
}

}  // namespace
}  // namespace weft::solver
