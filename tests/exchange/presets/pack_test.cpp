// SPDX-License-Identifier: Apache-2.0
#include "exchange/presets/pack.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/image/color_spaces.h"
#include "tests/exchange/presets/maps.h"

namespace weft::exchange {
namespace {

const std::vector<std::string> kPackedNormal = {"normal.x", "normal.y", "normal.z"};

TEST(Packing, FlipsFloatsBeforeTheyAreRounded) {
  TestMaps maps({4, 4});
  maps.set_slopes([](int, int) { return std::array<double, 2>{0, 0}; });
  for (const NormalDirection direction : {NormalDirection::kOpenGl, NormalDirection::kDirectX}) {
    Image<float> samples = maps.samples(file_of(kPackedNormal, {}, direction));
    TestMaps::round_to_bits(samples, 8);
    EXPECT_EQ(std::lround(255 * samples(1, 1, 0)), 128) << "flat is 128, whatever the direction";
    EXPECT_EQ(std::lround(255 * samples(1, 1, 1)), 128) << "a flipped byte would be 127";
    EXPECT_EQ(std::lround(255 * samples(1, 1, 2)), 255);
  }
}

TEST(Packing, TurnsTheSecondPartOfANormalForDirectX) {
  TestMaps maps({2, 2});
  maps.set_slopes([](int, int) { return std::array<double, 2>{0.3, -0.5}; });
  const Image<float> gl = maps.samples(file_of(kPackedNormal)),
                     dx = maps.samples(file_of(kPackedNormal, {}, NormalDirection::kDirectX));
  EXPECT_FLOAT_EQ(gl(0, 0, 0), dx(0, 0, 0));
  EXPECT_FLOAT_EQ(gl(0, 0, 1), 1 - dx(0, 0, 1));
  EXPECT_GT(gl(0, 0, 1), 0.5F) << "a surface that falls upwards faces up";
}

TEST(Packing, PutsColourThroughTheTransferFunctionOfSrgbAndDataNot) {
  TestMaps maps({3, 1});
  for (const MapPlane plane : {MapPlane::kAlbedoR, MapPlane::kAlbedoG, MapPlane::kAlbedoB})
    maps.set(plane, [](int x, int) { return 0.002 + 0.3 * x; });
  maps.set(MapPlane::kOpacity, 0.25);
  const Image<float> samples =
      maps.samples(file_of({"albedo.r", "albedo.g", "albedo.b", "opacity"}, {.color = ColorSpace::kSrgb}));
  for (int x = 0; x < 3; ++x) {
    const double linear = 0.002 + 0.3 * x;
    EXPECT_NEAR(samples(x, 0, 0), srgb_of_rec709({linear, linear, linear})[0], 1e-6);
    EXPECT_FLOAT_EQ(samples(x, 0, 3), 0.25F) << "alpha is no colour";
  }
}

TEST(Packing, GivesBackItsValuesFromItsSamples) {
  TestMaps maps({8, 8});
  maps.set(MapPlane::kHeight, [](int x, int y) { return -0.3 + 0.05 * x + 0.03 * y; });
  for (const MapPlane plane : {MapPlane::kAlbedoR, MapPlane::kAlbedoG, MapPlane::kAlbedoB})
    maps.set(plane, [](int x, int y) { return 0.01 * (x + 8 * y); });
  maps.set_slopes([](int x, int y) { return std::array<double, 2>{0.2 * x - 0.7, 0.1 * y}; });
  ChannelFacts facts;
  facts.height_least_mm = -0.3;
  facts.height_most_mm = 0.26;
  for (const auto& channels : std::vector<std::vector<std::string>>{
           kPackedNormal, {"height"}, {"albedo.r", "albedo.g", "albedo.b"}}) {
    for (const bool is_float : {false, true}) {
      const Stored stored = {.encoding = is_float ? Encoding::kExr : Encoding::kPng,
                             .bits = is_float ? 32 : 16,
                             .color = is_float ? ColorSpace::kLinearColor : ColorSpace::kSrgb};
      const PresetFile file = file_of(channels, stored);
      Image<float> read = maps.samples(file, facts), truth(maps.size(), read.planes());
      to_values(file, facts, TestMaps::views_of(read));
      pack_values(file, maps.planes(), facts, 0, TestMaps::views_of(truth));
      for (int c = 0; c < read.planes(); ++c) {
        for (int x = 0; x < 8; ++x)
          EXPECT_NEAR(read(x, 3, c), truth(x, 3, c), 2e-6) << channels[0] << ", " << c;
      }
    }
  }
}

TEST(Packing, HeightOfAPlainClothIsHalfAndNoDivisionByNothing) {
  TestMaps maps({2, 2});
  maps.set(MapPlane::kHeight, [](int, int) { return 0.7; });
  ChannelFacts facts;
  facts.height_least_mm = facts.height_most_mm = 0.7;
  Image<float> samples = maps.samples(file_of({"height"}), facts);
  EXPECT_EQ(samples(1, 1), 0.5F);
  to_values(file_of({"height"}), facts, TestMaps::views_of(samples));
  EXPECT_FLOAT_EQ(samples(1, 1), 0.7F);
}

TEST(Packing, AsksForMapsThatAreNotThere) {
  TestMaps maps({2, 2});
  maps.set(MapPlane::kAlbedoR, 0.5);
  const Result<void> lacks = check_file(file_of({"occlusion", "metallic"}), maps.planes(), "orm");
  ASSERT_FALSE(lacks);
  EXPECT_THAT(lacks.error().message(), testing::HasSubstr("preset orm: {name}.png"));
  EXPECT_THAT(lacks.error().message(), testing::HasSubstr("comes from the map occlusion"));
  EXPECT_TRUE(check_file(file_of({"metallic", "opacity", "zero"}), maps.planes(), "orm"))
      << "cloth is no metal and has no holes unless a map says so";
}

TEST(Packing, SaysNothingOfAClothWithoutHolesMetalAndDirection) {
  TestMaps maps({2, 2});
  EXPECT_FALSE(says_something(file_of({"opacity"}), maps.planes()));
  maps.set(MapPlane::kOpacity, 1.0);
  maps.set(MapPlane::kMetallic, 0.0);
  EXPECT_FALSE(says_something(file_of({"opacity", "metallic", "one"}), maps.planes()));
  maps.set(MapPlane::kAlpha, 0.2);
  maps.set(MapPlane::kAlphaAlong, 0.2);
  maps.set(MapPlane::kYarnDeg, 0.0);
  const PresetFile axis = file_of({"anisotropy.x", "anisotropy.y", "anisotropy"});
  EXPECT_FALSE(says_something(axis, maps.planes()));
  maps.set(MapPlane::kAlphaAlong, 0.1);
  EXPECT_TRUE(says_something(axis, maps.planes()));
  EXPECT_TRUE(says_something(file_of({"roughness"}), maps.planes())) << "a typed roughness is one";
}

}  // namespace
}  // namespace weft::exchange
