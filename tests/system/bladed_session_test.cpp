// SPDX-License-Identifier: Apache-2.0
// Sessions in which the edge of a blade's shadow tells how light spreads in the cloth.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "core/rig/session.h"
#include "solve/input/load.h"
#include "solve/input/session_input.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kShare = 0.3, kMean_mm = 0.3;

simulator::Scene bladed_cotton() {
  simulator::Scene scene = scene_named("cotton", {480, 360});
  scene.effects.interreflection = false;
  return scene;
}

class BladedSession : public testing::Test {
 protected:
  void make(const simulator::Scene& scene) const { simulate(scene, folder_); }
  solve::SolvePlan planned() const {
    Result<solve::SolvePlan> plan = solve::plan_session({.folder = folder_, .calibration = {}, .leds = {}});
    EXPECT_TRUE(plan) << plan.error().message();
    return plan ? std::move(*plan) : solve::SolvePlan();
  }
  static solve::Photographs loaded(const solve::SolvePlan& plan) {
    Result<solve::Photographs> session = solve::load_photographs(plan, {});
    EXPECT_TRUE(session) << session.error().message();
    return session ? std::move(*session) : solve::Photographs();
  }

  Workspace work_;
  const fs::path folder_ = work_ / "cloth.weft";
};

TEST_F(BladedSession, TellsHowFarLightSpreads) {
  make(bladed_cotton());
  const solve::SolvePlan plan = planned();
  ASSERT_TRUE(plan.blade);
  EXPECT_EQ(plan.blade->file, "raw/11_led01_blade.dng");
  const solve::Photographs session = loaded(plan);
  EXPECT_THAT(session.conditions.of_frames, IsEmpty());
  ASSERT_TRUE(session.conditions.facts.cloth_spread);
  const ClothSpreadFacts& spread = *session.conditions.facts.cloth_spread;
  EXPECT_EQ(spread.said, "measured");
  EXPECT_EQ(spread.led, 1);
  ASSERT_TRUE(spread.share_sigma && spread.mean_mm && spread.mean_sigma_mm);
  EXPECT_NEAR(spread.share, kShare, 1.5 * *spread.share_sigma) << "+- " << *spread.share_sigma;
  EXPECT_NEAR(*spread.mean_mm, kMean_mm, 1.5 * *spread.mean_sigma_mm) << "+- " << *spread.mean_sigma_mm;
  EXPECT_LT(*spread.share_sigma, 0.1);
  EXPECT_LT(*spread.mean_sigma_mm, 0.08);
  EXPECT_TRUE(std::get<solve::Mosaics>(session.frames).beside) << "it is taken off";
}

TEST_F(BladedSession, IsWhatAPersonSaysInstead) {
  make(bladed_cotton());
  solve::SolvePlan plan = planned();
  plan.cloth_spread = solver::ClothSpread{.share = 0};
  const solve::Photographs left = loaded(plan);
  EXPECT_FALSE(left.conditions.facts.cloth_spread);
  EXPECT_FALSE(std::get<solve::Mosaics>(left.frames).beside);
  plan.cloth_spread = solver::ClothSpread{.share = 0.2, .mean_mm = 0.4};
  const solve::Photographs said = loaded(plan);
  ASSERT_TRUE(said.conditions.facts.cloth_spread);
  EXPECT_EQ(said.conditions.facts.cloth_spread->said, "given");
  EXPECT_EQ(said.conditions.facts.cloth_spread->share, 0.2);
}

TEST_F(BladedSession, OfClothThatSpreadsNoLightIsLeftAsItIs) {
  simulator::Scene scene = bladed_cotton();
  scene.effects.translucency = false;
  make(scene);
  const solve::Photographs session = loaded(planned());
  ASSERT_TRUE(session.conditions.facts.cloth_spread);
  const ClothSpreadFacts& spread = *session.conditions.facts.cloth_spread;
  EXPECT_EQ(spread.said, "not_observable")
      << spread.share << " +- " << spread.share_sigma.value_or(0) << " over " << spread.mean_mm.value_or(0);
  EXPECT_FALSE(spread.mean_mm);
  EXPECT_FALSE(std::get<solve::Mosaics>(session.frames).beside);
}

TEST_F(BladedSession, WhoseBladeIsNotThereIsSolvedWithAWarning) {
  simulator::Scene scene = bladed_cotton();
  scene.blade.x_mm = 500;
  make(scene);
  const solve::Photographs session = loaded(planned());
  EXPECT_THAT(session.conditions.of_frames, ElementsAre(testing::Field(&Verdict::name, "BLADE_SHADOW")));
  ASSERT_TRUE(session.conditions.facts.cloth_spread);
  EXPECT_EQ(session.conditions.facts.cloth_spread->said, "told") << "by the cloth itself";
}

TEST_F(BladedSession, WithoutABladeIsToldByTheClothItself) {
  for (const bool interreflection : {false, true}) {
    simulator::Scene scene = bladed_cotton();
    scene.effects.interreflection = interreflection;
    make(scene);
    solve::SolvePlan plan = planned();
    plan.blade.reset();
    const solve::Photographs session = loaded(plan);
    ASSERT_TRUE(session.conditions.facts.cloth_spread) << "interreflection " << interreflection;
    const ClothSpreadFacts& spread = *session.conditions.facts.cloth_spread;
    EXPECT_EQ(spread.said, "told");
    EXPECT_NEAR(spread.share, kShare, 0.06) << "interreflection " << interreflection;
    EXPECT_NEAR(spread.mean_mm.value_or(0), kMean_mm, 0.1) << "interreflection " << interreflection;
    EXPECT_GT(session.sigma_slope, 0);
    EXPECT_LT(session.sigma_slope, 0.15);
    EXPECT_TRUE(std::get<solve::Mosaics>(session.frames).beside) << "it is taken off";
    fs::remove_all(folder_);
  }
}

}  // namespace
}  // namespace weft::test
