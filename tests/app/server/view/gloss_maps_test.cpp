// SPDX-License-Identifier: Apache-2.0
#include "solve/files/gloss_maps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/base/files.h"
#include "core/base/temporary_folder.h"
#include "core/base/vec.h"
#include "core/describe/field_json.h"
#include "core/image_io/image_io.h"
#include "core/solve/solve_record.h"
#include "core/solve/status_blend.h"
#include "solve/report/reflectance_report.h"

namespace weft::app {
namespace {

// A pixel without a lobe, one with its yarn along the axis, one with it across, one of the other material.
constexpr std::array<std::uint16_t, 4> kStatusOfPixels = {
    kShadowed, kGlossy, kGlossy | kYarnAcross | kSaturated, kGlossy | kSecondLobe};
constexpr int kCount = static_cast<int>(kStatusOfPixels.size());

solve::GlossFacts satin() {
  solve::GlossFacts facts;
  facts.lobes.resize(2);
  facts.lobes[0].refusal = solver::LobeRefusal::kNone;
  facts.lobes[0].lobe = {.family = solver::LobeFamily::kAnisotropicGgx,
                         .alpha = 0.4,
                         .f0 = 0.05,
                         .along = 0.25,
                         .axis = radians(120)};
  facts.lobes[1].refusal = solver::LobeRefusal::kNone;
  facts.lobes[1].lobe = {.family = solver::LobeFamily::kGgx, .alpha = 0.16, .f0 = 0.06};
  facts.share = 1;
  return facts;
}

class GlossMaps : public ::testing::Test {
 protected:
  GlossMaps() {
    Image<std::uint16_t> status({kCount, 1});
    for (int x = 0; x < kCount; ++x) status(x, 0) = kStatusOfPixels[static_cast<std::size_t>(x)];
    Result<ImageWriter> writer =
        ImageWriter::open(folder_.path() / "status.png", {kCount, 1}, {"Y"}, {.type = SampleType::kUint16});
    EXPECT_TRUE(writer && writer->write_rows(View<const std::uint16_t>(status.plane())) && writer->finish());
  }

  bool has(const char* file) const { return is_there(folder_.path() / file); }

  TemporaryFolder folder_;
};

TEST_F(GlossMaps, HaveTheLobeWhereItWasUsedAndTypedValuesElsewhere) {
  const Result<void> written =
      solve::write_gloss_maps(folder_.path(), satin(), AlbedoScale::kAbsolute, Compression::kNone, {}, true);
  ASSERT_TRUE(written) << written.error().message();
  const Result<LoadedImage> roughness = read_image(folder_.path() / "roughness.exr");
  ASSERT_TRUE(roughness) << roughness.error().message();
  const Result<LoadedImage> specular = read_image(folder_.path() / "specular.exr");
  ASSERT_TRUE(specular) << specular.error().message();
  struct Pixel {
    double roughness, alpha, along, yarn_deg, f0;
  };
  constexpr std::array<Pixel, 4> kExpected = {{{1, 1, 1, 0, solve::kTypedF0},
                                               {0.447214, 0.4, 0.1, 120, 0.05},
                                               {0.447214, 0.4, 0.1, 30, 0.05},
                                               {0.4, 0.16, 0.16, 0, 0.06}}};
  constexpr double kHalfFloat = 1.0 / 2048;
  for (int x = 0; x < kCount; ++x) {
    const Pixel& pixel = kExpected[static_cast<std::size_t>(x)];
    EXPECT_NEAR(roughness->channel("roughness")(x, 0), pixel.roughness, kHalfFloat) << x;
    EXPECT_NEAR(roughness->channel("alpha")(x, 0), pixel.alpha, kHalfFloat) << x;
    EXPECT_NEAR(roughness->channel("alpha_along")(x, 0), pixel.along, kHalfFloat) << x;
    EXPECT_NEAR(roughness->channel("yarn_deg")(x, 0), pixel.yarn_deg, 180 * kHalfFloat) << x;
    EXPECT_NEAR(specular->channel("f0")(x, 0), pixel.f0, 0.05 * kHalfFloat) << x;
  }
  EXPECT_TRUE(has("reflectance.png"));
}

TEST_F(GlossMaps, OfAPixelOfBothMaterialsLieBetweenThem) {
  const std::array<std::uint16_t, 2> pixels = {static_cast<std::uint16_t>(kGlossy | status_of_blend(2)),
                                               static_cast<std::uint16_t>(kGlossy | status_of_blend(5))};
  Image<std::uint16_t> status({2, 1});
  for (int x = 0; x < 2; ++x) status(x, 0) = pixels[static_cast<std::size_t>(x)];
  Result<ImageWriter> writer =
      ImageWriter::open(folder_.path() / "status.png", {2, 1}, {"Y"}, {.type = SampleType::kUint16});
  ASSERT_TRUE(writer && writer->write_rows(View<const std::uint16_t>(status.plane())) && writer->finish());
  ASSERT_TRUE(solve::write_gloss_maps(folder_.path(), satin(), AlbedoScale::kAbsolute, Compression::kNone, {},
                                      false));
  const Result<LoadedImage> roughness = read_image(folder_.path() / "roughness.exr"),
                            specular = read_image(folder_.path() / "specular.exr");
  ASSERT_TRUE(roughness && specular);
  for (int x = 0; x < 2; ++x) {
    const double second = x == 0 ? 0.25 : 0.625;
    EXPECT_NEAR(roughness->channel("alpha")(x, 0), 1 / ((1 - second) / 0.4 + second / 0.16), 5e-4) << x;
    EXPECT_NEAR(roughness->channel("alpha_along")(x, 0), 1 / ((1 - second) / 0.1 + second / 0.16), 5e-4) << x;
    EXPECT_NEAR(roughness->channel("yarn_deg")(x, 0), 120, 0.1) << x;
    EXPECT_NEAR(specular->channel("f0")(x, 0), (1 - second) * 0.05 + second * 0.06, 5e-5) << x;
  }
}

TEST_F(GlossMaps, OfTwoLobesInAPixelHaveTheAlphaThatOneNeeds) {
  solve::GlossFacts facts = satin();
  facts.lobes.resize(1);
  facts.lobes[0].lobe = {
      .family = solver::LobeFamily::kTwoGgx, .alpha = 0.15, .f0 = 0.05, .broad = 0.5, .broad_share = 0.4};
  ASSERT_TRUE(
      solve::write_gloss_maps(folder_.path(), facts, AlbedoScale::kAbsolute, Compression::kNone, {}, false));
  const Result<LoadedImage> roughness = read_image(folder_.path() / "roughness.exr");
  ASSERT_TRUE(roughness) << roughness.error().message();
  const double one = 1 / (0.6 / 0.15 + 0.4 / 0.5);
  EXPECT_NEAR(roughness->channel("alpha")(1, 0), one, 1e-4);
  EXPECT_NEAR(roughness->channel("alpha_along")(1, 0), one, 1e-4);
  EXPECT_NEAR(roughness->channel("roughness")(1, 0), std::sqrt(one), 3e-4);
}

// Golden warp: f0 is the largest of its three.
solve::GlossFacts lurex() {
  solve::GlossFacts facts = satin();
  facts.lobes[0].tint = solver::LobeTint{
      .f0 = {0.1, 0.08, 0.04}, .sigma = {0.002, 0.001, 0.001}, .sigma_of_tint = {0.1, 0.1, 0.1}};
  facts.f0_of_channels = {solve::F0OfChannels{{0.1, 0.08, 0.04}, {0.002, 0.001, 0.001}}, std::nullopt};
  return facts;
}

TEST_F(GlossMaps, OfATintHaveF0OfEachChannel) {
  ASSERT_TRUE(solve::write_gloss_maps(folder_.path(), lurex(), AlbedoScale::kAbsolute, Compression::kNone, {},
                                      false));
  const Result<LoadedImage> specular = read_image(folder_.path() / "specular.exr");
  ASSERT_TRUE(specular) << specular.error().message();
  constexpr std::array<std::array<double, 4>, 4> kExpected = {
      {{solve::kTypedF0, solve::kTypedF0, solve::kTypedF0, solve::kTypedF0},
       {0.1, 0.1, 0.08, 0.04},
       {0.1, 0.1, 0.08, 0.04},
       {0.06, 0.06, 0.06, 0.06}}};
  const std::array<const char*, 4> channels = {"f0", "R", "G", "B"};
  for (int x = 0; x < kCount; ++x) {
    for (std::size_t c = 0; c < channels.size(); ++c)
      EXPECT_NEAR(specular->channel(channels[c])(x, 0), kExpected[static_cast<std::size_t>(x)][c], 1e-4)
          << channels[c] << " of pixel " << x;
  }
}

TEST_F(GlossMaps, OfATintAreInReflectanceJsonAndInWords) {
  const solve::ReflectanceFacts said = solve::reflectance_facts(lurex(), AlbedoScale::kAbsolute);
  const Json document = object_of(said);
  EXPECT_EQ(document["schema"], "weft.reflectance/1.2");
  const Json& golden = document["clusters"][0];
  EXPECT_EQ(golden["f0_rgb"], Json({0.1, 0.08, 0.04}));
  EXPECT_EQ(golden["sigma"]["f0_rgb"], Json({0.002, 0.001, 0.001}));
  EXPECT_NEAR(golden["tint"][0].get<double>(), 2, 1e-12);
  EXPECT_FALSE(document["clusters"][1].contains("tint"));
  EXPECT_THAT(solve::reflectance_words(solve::summary_of(said)),
              testing::HasSubstr("f0 0.050 (0.100 red, 0.080 green, 0.040 blue); ggx"));
  const solve::ReflectanceFacts relative = solve::reflectance_facts(lurex(), AlbedoScale::kRelative);
  EXPECT_TRUE(relative.clusters.at(0).f0_rgb.empty());
  EXPECT_THAT(solve::reflectance_words(solve::summary_of(relative)),
              testing::HasSubstr("of red, green and blue 2.00, 1.60 and 0.80 times"));
  EXPECT_FALSE(
      object_of(solve::reflectance_facts(satin(), AlbedoScale::kAbsolute))["clusters"][0].contains("tint"));
}

TEST_F(GlossMaps, OfARelativeAlbedoSayNothingOfF0) {
  ASSERT_TRUE(solve::write_gloss_maps(folder_.path(), satin(), AlbedoScale::kRelative, Compression::kNone, {},
                                      false));
  EXPECT_TRUE(has("roughness.exr"));
  EXPECT_FALSE(has("specular.exr"));
  EXPECT_FALSE(has("reflectance.png"));
}

TEST_F(GlossMaps, AreNotWrittenWhereNoLobeWasMeasuredOrUsed) {
  solve::GlossFacts refused, unused = satin();
  refused.lobes.resize(1);
  unused.share = 0;
  for (const solve::GlossFacts& facts : {refused, unused}) {
    ASSERT_TRUE(
        solve::write_gloss_maps(folder_.path(), facts, AlbedoScale::kAbsolute, Compression::kNone, {}, true));
    EXPECT_FALSE(has("roughness.exr") || has("specular.exr") || has("reflectance.png"));
  }
}

TEST(ReflectanceWords, AreOfBothMaterials) {
  const solve::ReflectanceFacts said = solve::reflectance_facts(satin(), AlbedoScale::kAbsolute);
  const Json document = object_of(said);
  ASSERT_EQ(document["clusters"].size(), 2U);
  const ReflectanceSummary summary = solve::summary_of(said);
  ASSERT_TRUE(summary.second);
  EXPECT_EQ(summary.second->family, "ggx");
  EXPECT_EQ(solve::reflectance_words(summary),
            "two materials: anisotropic-ggx, roughness 0.400 across the yarn and 0.100 along it, f0 0.050; "
            "ggx, roughness 0.160, f0 0.060; solved with it: 100 percent of the frame");
  EXPECT_THAT(solve::reflectance_section(said).paragraphs.at(0), testing::HasSubstr("two materials"));
  EXPECT_TRUE(solve::reflectance_said(said).is_used);
  EXPECT_EQ(solve::reflectance_said(said).says, solve::reflectance_words(summary));
}

TEST(ReflectanceWords, AreOfTwoLobesInAPixel) {
  solve::GlossFacts facts = satin();
  facts.lobes.resize(1);
  facts.lobes[0].lobe = {
      .family = solver::LobeFamily::kTwoGgx, .alpha = 0.15, .f0 = 0.05, .broad = 0.5, .broad_share = 0.4};
  facts.lobes[0].sigma_broad = 0.02;
  facts.lobes[0].sigma_share = 0.01;
  const solve::ReflectanceFacts said = solve::reflectance_facts(facts, AlbedoScale::kAbsolute);
  const Json document = object_of(said);
  const Json& cluster = document["clusters"][0];
  EXPECT_EQ(cluster["family"], "two-ggx");
  EXPECT_EQ(cluster["alpha_broad"], 0.5);
  EXPECT_EQ(cluster["broad_share"], 0.4);
  EXPECT_NEAR(cluster["sigma"]["alpha_broad"].get<double>(), 0.01, 1e-12);
  EXPECT_EQ(cluster["sigma"]["broad_share"], 0.01);
  EXPECT_EQ(solve::lobes_in_words(solve::summary_of(said)),
            "two-ggx, roughness 0.150 and, for 40 percent of it, 0.500, f0 0.050");
}

TEST(ReflectanceWords, SayWhereRoughnessChanges) {
  solve::GlossFacts facts = satin();
  facts.lobes[0].parts = {{0, 0.2, 0.01, 900}, {1, 0.205, 0.01, 910}, {3, 0.26, 0.01, 890}};
  const solve::ReflectanceFacts said = solve::reflectance_facts(facts, AlbedoScale::kAbsolute);
  const Json document = object_of(said);
  const Json& cluster = document["clusters"][0];
  ASSERT_EQ(cluster["parts"].size(), 3U);
  EXPECT_EQ(cluster["parts"][2]["part"], "lower right");
  EXPECT_NEAR(cluster["parts"][2]["sigma"].get<double>(), 0.0026, 1e-12);
  const std::string warning =
      "the cloth's roughness changes across the frame: 0.200 at the upper left, 0.260 at the lower right";
  EXPECT_EQ(cluster["warning"], warning);
  EXPECT_THAT(solve::reflectance_section(said).paragraphs.at(1), testing::HasSubstr(warning));
  facts.lobes[0].parts.pop_back();
  EXPECT_FALSE(
      object_of(solve::reflectance_facts(facts, AlbedoScale::kAbsolute))["clusters"][0].contains("warning"));
}

TEST(ReflectanceWords, AreNoneWhereNoLobeWasMeasuredAndTheSectionSaysWhy) {
  solve::GlossFacts facts;
  facts.lobes.resize(1);
  facts.lobes[0].refusal = solver::LobeRefusal::kLambertFits;
  const solve::ReflectanceFacts said = solve::reflectance_facts(facts, AlbedoScale::kRelative);
  const Json document = object_of(said);
  EXPECT_EQ(solve::reflectance_words(solve::summary_of(said)), "");
  EXPECT_THAT(solve::reflectance_section(said).paragraphs.at(0), testing::HasSubstr("Not observable"));
  EXPECT_FALSE(solve::reflectance_said(said).is_used);
  EXPECT_THAT(solve::reflectance_said(said).says, testing::HasSubstr("Lambert"));
}

}  // namespace
}  // namespace weft::app
