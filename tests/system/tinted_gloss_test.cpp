// SPDX-License-Identifier: Apache-2.0
// Cloth whose highlights have a colour of their own, from its photographs to the maps that artists take.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "core/base/json_document.h"
#include "core/image_io/image_io.h"
#include "core/solve/solve_record.h"
#include "material/run/maps.h"
#include "solve/run/solve_session.h"
#include "tests/system/session_test.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
constexpr Rgb kGold = {0.1, 0.08, 0.04}, kDye = {0.06, 0.05, 0.08};

// The simulator's own GGX over a twill.
simulator::Scene lurex(const Rgb& f0) {
  simulator::Scene scene = scene_named("twill", {256, 160});
  scene.material = {};
  scene.material.albedo = kDye;
  scene.material.reflectance =
      simulator::Ggx{.alpha = 0.3, .f0 = f0, .beneath = simulator::Beneath::kBalanced};
  scene.effects = {};
  scene.effects.near_light = scene.effects.relief = scene.effects.reflectance = scene.effects.noise = true;
  return scene;
}

class TintedGloss : public testing::Test {
 protected:
  solve::SolveReport solved(const Rgb& f0) const {
    simulate(lurex(f0), session_);
    solve::SolveOptions options;
    options.method = "robust";
    options.previews = false;
    const auto report =
        solve::solve_session({.folder = session_, .calibration = {}, .leds = {}}, options, {});
    EXPECT_TRUE(report) << report.error().message();
    return report ? *report : solve::SolveReport();
  }
  static Json cluster_of(const solve::SolveReport& report) {
    const Result<Json> document = read_json(report.folder / "reflectance.json", "weft.reflectance", 1);
    EXPECT_TRUE(document);
    return document ? (*document)["clusters"][0] : Json();
  }

  Workspace work_;
  const fs::path session_ = work_ / "cloth.weft";
};

TEST_F(TintedGloss, IsMeasuredAndLeavesTheDyeItsColour) {
  const solve::SolveReport report = solved(kGold);
  const Json cluster = cluster_of(report);
  ASSERT_TRUE(cluster.contains("f0_rgb")) << cluster.dump();
  EXPECT_NEAR(cluster["alpha"].get<double>(), 0.3, 0.01);
  const Result<LoadedImage> albedo = read_image(report.folder / "albedo.exr");
  ASSERT_TRUE(albedo);
  const std::array<const char*, 3> channels = {"R", "G", "B"};
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(cluster["f0_rgb"][c].get<double>(), kGold[c], 0.05 * kGold[c]) << channels[c];
    double sum = 0;
    const View<const float> plane = albedo->channel(channels[c]);
    for (int y = 0; y < plane.height(); ++y) {
      for (int x = 0; x < plane.width(); ++x) sum += double{plane(x, y)};
    }
    const double mean = sum / static_cast<double>(albedo->info.size.pixels());
    EXPECT_NEAR(mean, kDye[c], 0.03 * kDye[c]) << channels[c];
  }
}

TEST_F(TintedGloss, IsASpecularColourOfTheMaps) {
  solved(kGold);
  material::MapsOptions options;
  options.session = session_;
  options.maps = {"roughness"};
  const auto made = material::make_maps(options, {});
  ASSERT_TRUE(made) << made.error().message();
  const Result<LoadedImage> specular = read_image(made->folder / "specular.exr"),
                            tint = read_image(made->folder / "specular_tint.exr");
  ASSERT_TRUE(specular && tint);
  const int x = tint->info.size.width / 2, y = tint->info.size.height / 2;
  const std::array<const char*, 3> channels = {"R", "G", "B"};
  for (std::size_t c = 0; c < 3; ++c) {
    const double f0 = double{specular->channel("f0")(x, y)} * double{tint->channel(channels[c])(x, y)};
    EXPECT_NEAR(f0, kGold[c], 0.05 * kGold[c]) << channels[c];
    EXPECT_LE(tint->channel(channels[c])(x, y), 1) << channels[c];
  }
}

TEST_F(TintedGloss, IsNotSaidOfWhiteHighlightsOnColouredCloth) {
  const solve::SolveReport report = solved({0.05, 0.05, 0.05});
  const Json cluster = cluster_of(report);
  ASSERT_TRUE(cluster["observable"].get<bool>()) << cluster.dump();
  EXPECT_FALSE(cluster.contains("tint"));
  const Result<ImageFileInfo> specular = read_image_info(report.folder / "specular.exr");
  ASSERT_TRUE(specular);
  EXPECT_EQ(specular->channels, std::vector<std::string>{"f0"});
}

}  // namespace
}  // namespace weft::test
