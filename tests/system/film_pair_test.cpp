// SPDX-License-Identifier: Apache-2.0
// Sessions that were photographed through crossed films and through parallel ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <vector>

#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "solve/input/load.h"
#include "solve/input/session_input.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class FilmPairSession : public testing::Test {
 protected:
  void SetUp() override {
    simulator::Scene scene = scene_named("golden", {48, 32});
    scene.films.states = simulator::FilmStates::kBoth;
    simulate(scene, folder_);
  }

  solve::SolvePlan planned(const fs::path& calibration = {}) const {
    Result<solve::SolvePlan> plan =
        solve::plan_session({.folder = folder_, .calibration = calibration, .leds = {}});
    EXPECT_TRUE(plan) << plan.error().message();
    return plan ? std::move(*plan) : solve::SolvePlan();
  }
  static solve::Photographs loaded(const solve::SolvePlan& plan) {
    Result<solve::Photographs> session = solve::load_photographs(plan, {});
    EXPECT_TRUE(session) << session.error().message();
    return session ? std::move(*session) : solve::Photographs();
  }
  void change(const std::function<void(Session&)>& how) const {
    Result<Session> session = read_session(folder_);
    ASSERT_TRUE(session) << session.error().message();
    how(*session);
    ASSERT_TRUE(write_session(*session));
  }

  Workspace work_;
  const fs::path folder_ = work_ / "cloth.weft";
};

TEST_F(FilmPairSession, IsSolvedCrossedAndKeepsTheParallelShots) {
  const solve::SolvePlan plan = planned();
  ASSERT_EQ(plan.lit.size(), 10U);
  ASSERT_EQ(plan.parallel.size(), 10U);
  for (std::size_t k = 0; k < 10; ++k) {
    EXPECT_EQ(plan.lit[k].polariser, Polariser::kCrossed);
    EXPECT_EQ(plan.parallel[k].led, plan.lit[k].led);
  }
  const solve::Photographs session = loaded(plan);
  EXPECT_DOUBLE_EQ(session.lobe_share, 0.02);
  ASSERT_TRUE(session.parallel);
  EXPECT_EQ(std::get<solve::Mosaics>(*session.parallel).count(), 10U);
  EXPECT_THAT(session.conditions.warnings, IsEmpty());
}

TEST_F(FilmPairSession, WithoutTheParallelShotOfALedIsTheCrossedHalfAlone) {
  change([](Session& session) {
    std::erase_if(session.shots,
                  [](const Shot& s) { return s.polariser == Polariser::kParallel && s.led == 4; });
  });
  const solve::SolvePlan plan = planned();
  EXPECT_THAT(plan.parallel, IsEmpty());
  EXPECT_THAT(plan.warnings, ElementsAre(HasSubstr("there is none of LED 4")));
  EXPECT_FALSE(loaded(plan).parallel);
}

TEST_F(FilmPairSession, OfParallelShotsAloneIsSolvedWithTwiceTheLobe) {
  change([](Session& session) {
    std::erase_if(session.shots, [](const Shot& s) {
      return s.role == ShotRole::kLit && s.polariser == Polariser::kCrossed;
    });
  });
  const solve::Photographs session = loaded(planned());
  EXPECT_DOUBLE_EQ(session.lobe_share, 2);
  EXPECT_FALSE(session.parallel);
}

// LEDs as bright as they are without films, and what films leave of their scattered light.
TEST_F(FilmPairSession, OfARigThatWasCalibratedWithoutItsFilmsHasTheSameStrengths) {
  const auto strength = [](const solve::Photographs& session) {
    return session.field->at(3, 1, 20, 10).strength;
  };
  const double through_films = strength(loaded(planned()));
  Result<Calibration> calibration = read_calibration(folder_ / "calibration");
  ASSERT_TRUE(calibration) << calibration.error().message();
  calibration->lights = brightened(std::move(*calibration->lights), std::vector<double>(10, 4.0));
  ASSERT_TRUE(write_calibration(work_ / "without_films", std::move(*calibration)));
  change([](Session& session) { session.films.scattered = 0.25; });
  EXPECT_NEAR(strength(loaded(planned(work_ / "without_films"))), through_films, 1e-6 * through_films);
}

}  // namespace
}  // namespace weft::test
