// SPDX-License-Identifier: Apache-2.0
// The reference level on simulated sessions in memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/vec.h"
#include "core/image_io/image_io.h"
#include "solve/input/load.h"
#include "solve/input/session_input.h"
#include "solve/levels/frame.h"
#include "solve/levels/reference.h"
#include "solve/levels/stages.h"
#include "solve/run/facts_json.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

constexpr Size kSize = {128, 96};

struct Solved {
  explicit Solved(Size size) : normal(size, 3) {}
  Result<void> operator()(const solve::MapBand& band) {
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < band.rows.height(); ++y) {
        std::copy_n(band.normal[static_cast<std::size_t>(c)].row(y), band.rows.width(),
                    normal.plane(c).row(band.rows.y0 + y));
      }
    }
    return {};
  }

  Image<float> normal;
  solve::FrameFacts facts;
};

Vec3 normal_at(const Image<float>& normal, int x, int y) {
  return {normal(x, y, 0), normal(x, y, 1), normal(x, y, 2)};
}

double mean_angle_deg(const Image<float>& a, const Image<float>& b) {
  double sum = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) sum += angle_deg(normal_at(a, x, y), normal_at(b, x, y));
  }
  return sum / static_cast<double>(a.size().pixels());
}

class ReferenceLevel : public testing::Test {
 protected:
  void photograph(const simulator::Scene& scene) {
    simulate(scene, session_);
    Result<LoadedImage> truth = read_image(session_ / "truth" / "normal.exr");
    ASSERT_TRUE(truth) << truth.error().message();
    truth_ = std::move(truth->planes);
  }
  // The photographs, with lights said to be so many times as bright as they are and albedo without a scale.
  solve::Photographs photographs(double brighter = 1) const {
    auto loaded = solve::load_photographs(
        *solve::plan_session({.folder = session_, .calibration = {}, .leds = {}}), {});
    EXPECT_TRUE(loaded) << loaded.error().message();
    solve::Photographs photographs = std::move(*loaded);
    if (brighter == 1) return photographs;
    NearLights lights = std::get<NearLights>(photographs.field->lights());
    for (auto& led : lights.leds) {
      for (double& flux : led.flux_rgb) flux *= brighter;
    }
    photographs.field =
        *LightField::make(lights, photographs.camera, kSize, photographs.field->cloth_height_mm());
    photographs.albedo_scale = AlbedoScale::kRelative;
    return photographs;
  }
  static Solved solve(const solve::Photographs& photographs, const char* level) {
    Solved solved(photographs.size);
    auto facts = solve::solve_frame(photographs, *solver::find_method(level), solve::kSolveTile,
                                    {.threads = 2}, std::ref(solved));
    EXPECT_TRUE(facts) << facts.error().message();
    solved.facts = std::move(*facts);
    return solved;
  }
  double error_deg(const solve::Photographs& photographs, const char* level) const {
    return mean_angle_deg(solve(photographs, level).normal, truth_);
  }

  Workspace work_;
  const std::filesystem::path session_ = work_ / "cloth.weft";
  Image<float> truth_;
};

TEST_F(ReferenceLevel, IsAsGoodWhereTheCameraIsTurned) {
  for (const double roll_deg : {90.0, 180.0}) {
    simulator::Scene scene = scene_named("deep", kSize);
    scene.camera.pose.roll_deg = roll_deg;
    photograph(scene);
    EXPECT_LT(error_deg(photographs(), "reference"), 1.8) << "turned by " << roll_deg << " degrees";
    std::filesystem::remove_all(session_);
  }
}

TEST_F(ReferenceLevel, LeavesAClothAloneThatShowsNeitherShadowsNorBounces) {
  simulator::Scene scene = scene_named("deep", kSize);
  scene.effects.cast_shadows = scene.effects.interreflection = false;
  photograph(scene);
  const solve::Photographs taken = photographs();
  const Solved reference = solve(taken, "reference");
  EXPECT_TRUE(reference.facts.reference->gates.shadows()) << "there would be shadows on such slopes";
  EXPECT_FALSE(reference.facts.reference->stages.any());
  EXPECT_LE(mean_angle_deg(reference.normal, truth_), 1.02 * error_deg(taken, "robust"));
}

TEST_F(ReferenceLevel, IsTheSameForIntensitiesOfAnyScale) {
  photograph(scene_named("deep", kSize));
  const solve::Photographs dark = photographs(0.1), bright = photographs(10);
  std::map<std::string, double> error;
  for (const char* level : {"fast", "standard", "robust", "reference"}) {
    const Solved a = solve(dark, level), b = solve(bright, level);
    EXPECT_LT(mean_angle_deg(a.normal, b.normal), 0.01) << level;
    error[level] = mean_angle_deg(a.normal, truth_);
  }
  EXPECT_LT(error["reference"], 0.6 * error["robust"]);
}

TEST_F(ReferenceLevel, OfGlossAndOfWhiteClothIsTheSameForIntensitiesOfAnyScale) {
  simulator::Scene white = scene_named("deep", kSize);
  white.material.albedo.fill(0.8);
  const std::vector<std::pair<simulator::Scene, const char*>> solves = {
      {scene_named("gloss_satin", kSize), "robust"}, {white, "reference"}};
  for (const auto& [scene, level] : solves) {
    photograph(scene);
    const Solved dim = solve(photographs(0.05), level), bright = solve(photographs(20), level);
    EXPECT_LT(mean_angle_deg(dim.normal, bright.normal), 0.02) << scene.fabric << ", " << level;
    EXPECT_EQ(bright.facts.gloss->is_measured(), dim.facts.gloss->is_measured()) << scene.fabric;
    std::filesystem::remove_all(session_);
  }
}

TEST_F(ReferenceLevel, OfGlossWithoutBouncesIsNoWorseThanRobust) {
  simulator::Scene scene = scene_named("gloss_satin", kSize);
  scene.effects.cast_shadows = scene.effects.interreflection = false;
  photograph(scene);
  for (const double scale : {1.0, 0.3}) {
    const solve::Photographs taken = photographs(scale);
    const Solved robust = solve(taken, "robust");
    ASSERT_TRUE(robust.facts.gloss->is_measured()) << scale;
    EXPECT_LE(error_deg(taken, "reference"), 1.01 * mean_angle_deg(robust.normal, truth_)) << scale;
  }
}

TEST_F(ReferenceLevel, TakesBouncesOutOfWhiteClothWhoseAlbedoHasNoScale) {
  simulator::Scene scene = scene_named("deep", kSize);
  for (const double albedo : {0.6, 0.8}) {
    scene.material.albedo.fill(albedo);
    photograph(scene);
    const solve::Photographs taken = photographs(0.3);
    EXPECT_LT(error_deg(taken, "reference"), 0.6 * error_deg(taken, "robust")) << "albedo " << albedo;
    std::filesystem::remove_all(session_);
  }
}

TEST_F(ReferenceLevel, IsNoWorseOnAShallowWeaveOfUnknownAlbedo) {
  photograph(scene_named("plain_family", kSize));
  const solve::Photographs dark = photographs(0.3);
  EXPECT_LE(error_deg(dark, "reference"), 1.02 * error_deg(dark, "robust"));
}

TEST_F(ReferenceLevel, RefusesARoundThatTurnsNormalsMoreThanTheOneBefore) {
  photograph(scene_named("deep", kSize));
  const solve::Photographs dark = photographs(0.2);
  std::vector<solve::Stage> forced = solve::stages_of(solver::method_of(solver::Level::kReference));
  for (const char* judge : {"gates", "choice", "comparison"})
    forced = solve::without(judge, std::move(forced));
  Solved solved(kSize);
  const auto facts = solve::solve_by(forced, dark, solve::kSolveTile, {.threads = 2}, std::ref(solved));
  ASSERT_TRUE(facts) << facts.error().message();
  int refused = 0;
  for (const solve::ReferenceRound& round : facts->reference->rounds) refused += round.is_refused;
  EXPECT_EQ(refused, 1) << "albedo is taken for five times what it is";
}

TEST_F(ReferenceLevel, LooksCoarselyUntilTheLastRoundAndTakesNoneThatWouldTurnNothing) {
  photograph(scene_named("plain_family", kSize));
  const solve::Photographs taken = photographs();
  const auto error_and_rounds = [&](const solve::ReferenceOptions& options) {
    Solved solved(kSize);
    const auto facts =
        solve::solve_by(solve::stages_of(solver::method_of(solver::Level::kReference), options), taken,
                        solve::kSolveTile, {.threads = 2}, std::ref(solved));
    EXPECT_TRUE(facts) << facts.error().message();
    return std::pair(mean_angle_deg(solved.normal, truth_), facts->reference->rounds.size());
  };
  const auto [by_all, all] = error_and_rounds({.settled_deg = 0, .early_directions = 12, .early_steps = 16});
  const auto [error, rounds] = error_and_rounds({});
  EXPECT_LT(rounds, all);
  EXPECT_LT(error, 1.01 * by_all);
}

// Light between yarns shows where patches choose, and nowhere else.
TEST_F(ReferenceLevel, PublishesTheSolutionOfRobustWhereThatPredictsLeftOutLightBetter) {
  simulator::Scene scene = scene_named("deep", {256, 192});
  photograph(scene);
  solve::Photographs taken = photographs();
  std::filesystem::remove_all(session_);
  scene.effects.cast_shadows = scene.effects.interreflection = false;
  photograph(scene);
  const solve::Photographs bare = photographs();
  for (const solver::Patch& patch : solver::patches_of(taken.size, solver::PatchUse::kReport)) {
    const int y0 = patch.pixels.y0 / kRowGroup * kRowGroup;
    for (std::size_t k = 0; k < taken.count(); ++k) {
      for (int y = y0; y < y0 + kRowGroup; ++y) {
        for (int x = patch.pixels.x0; x < patch.pixels.x0 + kRowGroup; ++x)
          taken.mosaics()->frames[k].counts(x, y) = bare.mosaics()->frames[k].counts(x, y);
      }
    }
  }
  const Solved robust = solve(taken, "robust"), reference = solve(taken, "reference");
  const solve::ReferenceFacts& facts = *reference.facts.reference;
  EXPECT_TRUE(facts.choice.stages.any()) << "of the first round";
  EXPECT_TRUE(facts.robust_is_published) << "gain over robust " << facts.over_robust.mean;
  EXPECT_FALSE(facts.stages.any());
  EXPECT_LT(mean_angle_deg(robust.normal, reference.normal), 1e-4);
  EXPECT_EQ(solve::facts_of(facts).published, "robust");
  EXPECT_THAT(solve::warnings_of(facts), testing::Contains(testing::HasSubstr("that of robust")));
}

TEST_F(ReferenceLevel, AsksForTheMemoryOfItsFrames) {
  photograph(scene_named("flat", kSize));
  solve::SolvePlan plan = *solve::plan_session({.folder = session_, .calibration = {}, .leds = {}});
  const std::uint64_t of_tiles = solve::memory_needed(plan, 1);
  plan.extent = solver::Extent::kWholeFrame;
  EXPECT_GE(solve::memory_needed(plan, 1), of_tiles + 69 * static_cast<std::uint64_t>(kSize.pixels()));
}

}  // namespace
}  // namespace weft::test
