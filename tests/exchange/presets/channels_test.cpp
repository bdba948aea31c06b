// SPDX-License-Identifier: Apache-2.0
#include "exchange/presets/channels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

namespace weft::exchange {
namespace {

float value_of(const char* channel, const std::vector<float>& planes, const ChannelFacts& facts = {}) {
  const Channel* found = channel_named(channel);
  EXPECT_NE(found, nullptr) << channel;
  return found == nullptr ? NAN : found->value(planes.data(), facts);
}

TEST(ChannelCatalogue, NamesEachChannelOnceAndTakesAtMostFourPlanes) {
  std::set<std::string> names;
  for (const Channel& channel : channel_catalogue()) {
    EXPECT_TRUE(names.insert(channel.name).second) << channel.name << " stands twice";
    EXPECT_LE(channel.planes.size(), 4U) << channel.name;
    EXPECT_LT(channel.least, channel.most) << channel.name;
    EXPECT_STRNE(channel.says, "") << channel.name;
  }
}

TEST(RoughnessConvention, LeadsBackToAlphaFromEachOfItsNames) {
  for (std::size_t i = 0; i < kRoughnessConventionNames.size(); ++i) {
    const auto convention = static_cast<RoughnessConvention>(i);
    for (const double alpha : {0.02, 0.1, 0.25, 0.5, 0.81}) {
      const double written = in_convention(convention, alpha);
      EXPECT_GE(written, 0) << kRoughnessConventionNames[i];
      EXPECT_LE(written, 1) << kRoughnessConventionNames[i];
      EXPECT_NEAR(alpha_in(convention, written), alpha, 1e-12) << kRoughnessConventionNames[i];
    }
  }
}

TEST(RoughnessConvention, HasTheValuesOfItsFormulas) {
  EXPECT_DOUBLE_EQ(in_convention(RoughnessConvention::kRoot, 0.25), 0.5);
  EXPECT_DOUBLE_EQ(in_convention(RoughnessConvention::kSmoothness, 0.25), 0.5);
  EXPECT_DOUBLE_EQ(in_convention(RoughnessConvention::kSmoothness, 0.09), 0.7);
  EXPECT_NEAR(in_convention(RoughnessConvention::kGloss, std::sqrt(2.0 / (1 + std::exp2(9)))), 0.5, 1e-12);
  EXPECT_NEAR(in_convention(RoughnessConvention::kBlinnPhong, std::sqrt(2.0 / (std::exp2(6.5) + 2))), 0.5,
              1e-12);
}

TEST(Channel, RoughnessIsOfTheGeometricMeanOfBothAlphas) {
  EXPECT_NEAR(value_of("roughness", {0.04F, 0.25F}), std::sqrt(0.1), 1e-6);
  EXPECT_NEAR(value_of("roughness.least", {0.25F, 0.04F}), 0.2, 1e-6);
}

TEST(Channel, AnisotropyMakesTheLargerAlphaOfTheSmaller) {
  const double small = 0.09, large = 0.36;
  const auto s =
      static_cast<double>(value_of("anisotropy", {static_cast<float>(large), static_cast<float>(small)}));
  EXPECT_NEAR(small + (1 - small) * s * s, large, 1e-6);
  EXPECT_EQ(value_of("anisotropy", {0.3F, 0.3F}), 0.0F);
  EXPECT_EQ(value_of("anisotropy", {1.0F, 1.0F}), 0.0F) << "no division by 0";
}

TEST(Channel, DirectionIsWhereTheHighlightIsStretched) {
  // A yarn along x that is smoother along itself stretches its highlight across.
  EXPECT_NEAR(value_of("anisotropy.x", {0.4F, 0.1F, 0}), 0, 1e-6);
  EXPECT_NEAR(value_of("anisotropy.y", {0.4F, 0.1F, 0}), 1, 1e-6);
  EXPECT_NEAR(value_of("anisotropy.x", {0.1F, 0.4F, 60}), 0.5, 1e-6);
  EXPECT_EQ(value_of("anisotropy.x", {0.2F, 0.2F, 60}), 1.0F) << "a round lobe has the direction of nothing";
}

TEST(Channel, DetailHasMeanSlopesTakenOutAndAlbedoOverItsMean) {
  ChannelFacts facts;
  facts.mean_slope = {0.2, -0.1};
  facts.mean_luminance = 0.4;
  // The normal of just that slope is flat.
  const double z = 1 / std::sqrt(0.2 * 0.2 + 0.1 * 0.1 + 1);
  const std::vector<float> normal = {static_cast<float>(-0.2 * z), static_cast<float>(0.1 * z),
                                     static_cast<float>(z)};
  EXPECT_NEAR(value_of("detail.normal.x", normal, facts), 0, 1e-6);
  EXPECT_NEAR(value_of("detail.normal.y", normal, facts), 0, 1e-6);
  EXPECT_NEAR(value_of("detail.albedo", {0.4F, 0.4F, 0.4F}, facts), 0.5, 1e-6);
}

TEST(Channel, HighlightsOfMetalHaveItsAlbedo) {
  EXPECT_EQ(value_of("specular_tint.r", {0.3F, 0, 0.9F}), 0.9F);
  EXPECT_NEAR(value_of("specular_tint.r", {0.3F, 1, 0.9F}), 0.3, 1e-6);
  EXPECT_NEAR(value_of("specular", {0.04F}), 0.5, 1e-6);
}

TEST(Channel, UnknownNamesHaveANearestOne) {
  EXPECT_EQ(channel_named("ocludsion"), nullptr);
  EXPECT_EQ(nearest_channel("oclusion"), "occlusion");
}

}  // namespace
}  // namespace weft::exchange
