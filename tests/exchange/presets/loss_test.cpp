// SPDX-License-Identifier: Apache-2.0
#include "exchange/presets/loss.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/exchange/presets/maps.h"

namespace weft::exchange {
namespace {

const std::vector<std::string> kLostNormal = {"normal.x", "normal.y", "normal.z"};
const std::vector<std::string> kLostAlbedo = {"albedo.r", "albedo.g", "albedo.b"};

Loss loss_at(const TestMaps& maps, const PresetFile& file) {
  Image<float> samples = maps.samples(file);
  TestMaps::round_to_bits(samples, file.stored.bits);
  return measure_loss(file, maps.planes(), {}, std::move(samples));
}

TEST(Loss, OfAFlatNormalInEightBitsIsWhatOneHalfStepTurnsIt) {
  TestMaps maps({4, 4});
  maps.set_slopes([](int, int) { return std::array<double, 2>{0, 0}; });
  const Loss loss = loss_at(maps, file_of(kLostNormal));
  ASSERT_TRUE(loss.normal);
  // 128 of 255 is 1/255 in x and in y.
  const double expected = std::atan(std::sqrt(2.0) / 255) * 180 / 3.14159265358979;
  EXPECT_NEAR(loss.normal->mean_deg, expected, 1e-4);
  EXPECT_NEAR(loss.normal->max_deg, expected, 1e-4);
  EXPECT_NEAR(loss.normal->p95_deg / expected, 1, 0.02);
}

TEST(Loss, OfNormalsInSixteenBitsIsUnderAThousandthOfADegree) {
  TestMaps maps({64, 64});
  maps.set_slopes([](int x, int y) { return std::array<double, 2>{0.02 * x - 0.6, 0.01 * y}; });
  const Loss eight = loss_at(maps, file_of(kLostNormal)),
             sixteen = loss_at(maps, file_of(kLostNormal, {.bits = 16}));
  EXPECT_LT(sixteen.normal->mean_deg, 0.001);
  EXPECT_GT(eight.normal->mean_deg, 0.1);
  EXPECT_NEAR(eight.normal->mean_deg / sixteen.normal->mean_deg, 257, 30);
}

TEST(Loss, SeesAFlippedDirectionAsTwiceItsTilt) {
  TestMaps maps({4, 4});
  maps.set_slopes([](int, int) { return std::array<double, 2>{0, std::tan(0.2)}; });
  Image<float> flipped = maps.samples(file_of(kLostNormal, {.bits = 16}, NormalDirection::kDirectX));
  const Loss loss = measure_loss(file_of(kLostNormal, {.bits = 16}), maps.planes(), {}, std::move(flipped));
  EXPECT_NEAR(loss.normal->mean_deg, 0.4 * 180 / 3.14159265358979, 0.01);
}

TEST(Loss, OfASlopeOf89DegreesIsThatOfItsDirection) {
  TestMaps maps({4, 4});
  maps.set_slopes([](int, int) { return std::array<double, 2>{std::tan(89 * 3.14159265358979 / 180), 0}; });
  const Loss three = loss_at(maps, file_of(kLostNormal));
  EXPECT_LT(three.normal->max_deg, 0.4) << "of three parts";
  const Loss two = loss_at(maps, file_of({"normal.x", "normal.y"}));
  EXPECT_GT(two.normal->max_deg, 0.5) << "of two parts the third is rebuilt from a difference near 0";
  EXPECT_LT(two.normal->max_deg, 6);
}

TEST(Loss, OfAlbedoIsInReflectanceAndInDecibelsOfItsSamples) {
  TestMaps maps({16, 16});
  for (const MapPlane plane : {MapPlane::kAlbedoR, MapPlane::kAlbedoG, MapPlane::kAlbedoB})
    maps.set(plane, [](int x, int y) { return 0.003 * (x + 16 * y); });
  const PresetFile file = file_of(kLostAlbedo, {.color = ColorSpace::kSrgb});
  Image<float> samples = maps.samples(file);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) samples(x, y, 1) += 0.01F;
  }
  const Loss loss = measure_loss(file, maps.planes(), {}, std::move(samples));
  ASSERT_TRUE(loss.albedo && loss.albedo->psnr_db);
  EXPECT_NEAR(*loss.albedo->psnr_db, -10 * std::log10(1e-4 / 3), 0.01);
  EXPECT_GT(loss.albedo->mean_abs, 0.001);
}

TEST(Loss, OfFloatsIsNothingAndHasNoDecibels) {
  TestMaps maps({4, 4});
  for (const MapPlane plane : {MapPlane::kAlbedoR, MapPlane::kAlbedoG, MapPlane::kAlbedoB})
    maps.set(plane, 0.3);
  const PresetFile file = file_of(kLostAlbedo, {.encoding = Encoding::kExr, .bits = 32});
  const Loss loss = measure_loss(file, maps.planes(), {}, maps.samples(file));
  EXPECT_EQ(loss.albedo->mean_abs, 0);
  EXPECT_FALSE(loss.albedo->psnr_db);
  EXPECT_NEAR(loss.channels[0].mean, 0.3, 1e-6);
}

TEST(Loss, CountsPixelsThatAnIntegerCannotHold) {
  TestMaps maps({4, 1});
  maps.set(MapPlane::kAlbedoR, [](int x, int) { return -0.1 + 0.5 * x; });  // -0.1, 0.4, 0.9, 1.4
  maps.set(MapPlane::kAlbedoG, 0.5);
  maps.set(MapPlane::kAlbedoB, 0.5);
  const Loss loss = loss_at(maps, file_of(kLostAlbedo, {.color = ColorSpace::kSrgb}));
  EXPECT_EQ(loss.channels[0].cut, 2);
  EXPECT_EQ(loss.channels[1].cut, 0);
  EXPECT_NEAR(loss.channels[0].most_abs, 0.4, 1e-6);
}

TEST(Loss, OfHalfEndsAtItsLargestNumberAndSaysSo) {
  TestMaps maps({3, 1});
  maps.set(MapPlane::kHeight, [](int x, int) { return x == 0 ? 1.0 : x == 1 ? 65504.0 : 1e6; });
  const PresetFile file = file_of({"height"}, {.encoding = Encoding::kExr, .bits = 16});
  Image<float> read = maps.samples(file);
  read(2, 0) = 65504;
  const Loss loss = measure_loss(file, maps.planes(), {}, std::move(read));
  EXPECT_EQ(loss.channels[0].cut, 1);
  EXPECT_NEAR(loss.channels[0].most_abs, 1e6 - 65504, 1);
}

}  // namespace
}  // namespace weft::exchange
