// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/accuracy_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace weft::bench {
namespace {

TEST(AccuracyScenes, AreThreeFamiliesInSixMaterialsByDistinctNames) {
  std::set<std::string> names;
  for (const AccuracyScene& scene : accuracy_scenes(SceneSet::kHeldOut, 1, false)) names.insert(scene.name);
  EXPECT_EQ(names.size(), 18U);
  EXPECT_TRUE(names.contains("deep dark-satin"));
}

TEST(AccuracyScenes, SetsShareNoWeaveAndNoSeed) {
  std::set<double> pitches;
  std::set<std::int64_t> seeds;
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    for (const SceneSet set : {SceneSet::kTuning, SceneSet::kHeldOut}) {
      const std::vector<AccuracyScene> scenes = accuracy_scenes(set, seed, true);
      EXPECT_TRUE(seeds.insert(scenes.front().scene.seed).second) << name_of(set) << ' ' << seed;
      for (const AccuracyScene& scene : scenes) {
        const double pitch = scene.scene.geometry.warp_pitch_mm;
        EXPECT_EQ(pitch < 0.8, set == SceneSet::kTuning) << scene.name << ": " << pitch << " mm";
        pitches.insert(pitch);
      }
    }
  }
  EXPECT_EQ(pitches.size(), 2U * 10 * 3) << "a weave for each set, seed and family";
}

TEST(AccuracyScenes, PatchesLieInTheFrameOnWholeFilterCells) {
  for (const bool quick : {false, true}) {
    for (const AccuracyScene& scene : accuracy_scenes(SceneSet::kTuning, 1, quick)) {
      ASSERT_TRUE(simulator::check_scene(scene.scene).has_value()) << scene.name;
      for (const Rect& r : scene.patches) {
        EXPECT_TRUE(r.x0 >= 0 && r.y0 >= 0 && r.x1 <= scene.scene.camera.width &&
                    r.y1 <= scene.scene.camera.height);
        EXPECT_TRUE(r.x0 % 2 == 0 && r.y0 % 2 == 0) << r.x0 << ", " << r.y0;
      }
    }
  }
}

class RenderedPatch : public testing::Test {
 protected:
  // The first scene, smooth and Lambert, without bounced light: all of it is in the solver's model. Near a
  // corner, so that a field of the wrong place would show.
  static void SetUpTestSuite() {
    AccuracyScene scene = accuracy_scenes(SceneSet::kTuning, 1, false).front();
    scene.scene.effects.interreflection = false;
    const Rect corner = scene.patches.back();
    Result<ClothPatch> rendered =
        render_patch(scene.scene, {corner.x0, corner.y0, corner.x0 + 48, corner.y0 + 48}, 1);
    ASSERT_TRUE(rendered.has_value()) << rendered.error().message();
    patch_ = new ClothPatch(std::move(*rendered));
  }
  static void TearDownTestSuite() { delete patch_; }
  static inline ClothPatch* patch_ = nullptr;
};

TEST_F(RenderedPatch, ReadsWhatItsLightFieldAndItsTruthPredict) {
  const CfaPattern cfa = patch_->photographs.planes().cfa;
  double normalized_square = 0, bias = 0, count = 0;
  for (int k = 0; k < patch_->readings.planes(); ++k) {
    for (int y = 0; y < 48; ++y) {
      for (int x = 0; x < 48; ++x) {
        const int c = cfa.channel_at(x, y);
        const LightField::Light light = patch_->field().at(static_cast<std::size_t>(k), c, x, y);
        const double cosine = patch_->normal(x, y, 0) * light.direction.x +
                              patch_->normal(x, y, 1) * light.direction.y +
                              patch_->normal(x, y, 2) * light.direction.z;
        ASSERT_EQ(patch_->visible(x, y, k), cosine > 0 ? 1.0F : 0.0F) << "nothing shades a smooth cloth";
        const double predicted = patch_->albedo(x, y, c) * light.strength * cosine;
        const double error = patch_->readings(x, y, k) - predicted;
        bias += error / predicted;
        const NoiseModel noise = *patch_->photographs.noise();
        normalized_square += error * error / (noise.variance(predicted) + noise.shared);
        ++count;
      }
    }
  }
  EXPECT_NEAR(bias / count, 0, 5e-4);
  EXPECT_NEAR(normalized_square / count, 1, 0.04);
}

TEST_F(RenderedPatch, KeepsReadingsAndFieldOfTheLightsThatAreChosen) {
  const Result<ClothPatch> fewer = with_lights(*patch_, {2, 5, 9});
  ASSERT_TRUE(fewer.has_value()) << fewer.error().message();
  ASSERT_EQ(fewer->field().count(), 3U);
  EXPECT_EQ(fewer->readings(7, 5, 2), patch_->readings(7, 5, 8));
  EXPECT_EQ(fewer->visible(7, 5, 1), patch_->visible(7, 5, 4));
  EXPECT_EQ(fewer->field().at(2, 1, 7, 5).direction, patch_->field().at(8, 1, 7, 5).direction);
  EXPECT_EQ(fewer->photographs.count(), 3U);
  EXPECT_FALSE(with_lights(*patch_, {2, 5, 11}).has_value());
}

}  // namespace
}  // namespace weft::bench
