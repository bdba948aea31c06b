// SPDX-License-Identifier: Apache-2.0
#include "solve/levels/stages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "core/base/vec.h"
#include "tests/solve/cloth.h"

namespace weft::solve {
namespace {

using solver::Level;
using testing::ElementsAre;

constexpr Size kGlossyFrame = {256, 192};

std::vector<Stage> level_without(Level level, std::initializer_list<const char*> names) {
  std::vector<Stage> stages = stages_of(solver::method_of(level));
  for (const char* name : names) stages = without(name, std::move(stages));
  return stages;
}

std::vector<std::string> names_of(const std::vector<Stage>& stages) {
  std::vector<std::string> names;
  for (const Stage& stage : stages) names.push_back(stage.name);
  return names;
}

// Dark and glossy, 20 degrees steep to both sides.
Photographs glossy_dimples() {
  const auto dimpled = [](int x, int y) {
    return normalized({0.26 * std::sin(2 * kPi * x / 37), 0.26 * std::sin(2 * kPi * y / 23), 1});
  };
  return mosaics(kGlossyFrame, {.normal = dimpled,
                                .albedo = {0.1, 0.08, 0.06},
                                .lobe = {.family = solver::LobeFamily::kGgx, .alpha = 0.25, .f0 = 0.05}});
}

struct SolvedFrameMaps {
  WholeMaps maps{kGlossyFrame};
  FrameFacts facts;
};

SolvedFrameMaps solved_by(const std::vector<Stage>& stages, const Photographs& photographs) {
  SolvedFrameMaps solved;
  auto facts = solve_by(stages, photographs, kSolveTile, {.threads = 2}, std::ref(solved.maps));
  EXPECT_TRUE(facts) << facts.error().message();
  if (facts) solved.facts = std::move(*facts);
  return solved;
}

bool are_same(const Image<float>& a, const Image<float>& b) {
  for (int c = 0; c < a.planes(); ++c) {
    for (int y = 0; y < a.height(); ++y) {
      if (!std::equal(a.plane(c).row(y), a.plane(c).row(y) + a.width(), b.plane(c).row(y))) return false;
    }
  }
  return true;
}

bool are_same(const SolvedFrameMaps& a, const SolvedFrameMaps& b) {
  return are_same(a.maps.normal, b.maps.normal) && are_same(a.maps.albedo, b.maps.albedo);
}

TEST(Stages, OfALevelBeginWithItsMethodOrThatOfStandard) {
  for (const auto& [name, first] :
       {std::pair{"preview", "preview"}, std::pair{"fast", "fast"}, std::pair{"standard", "standard"},
        std::pair{"robust", "standard"}, std::pair{"reference", "standard"}, std::pair{"wls", "wls"}})
    EXPECT_EQ(stages_of(*solver::find_method(name)).front().name, first) << name;
}

TEST(Stages, OfAMethodAreThoseOfAQuickLevel) {
  EXPECT_THAT(names_of(stages_of(*solver::find_method("lts"))),
              ElementsAre("lts", "sharpen", "realign", "check", "solve"));
}

TEST(Stages, WithoutThoseOfALevelAreThoseOfTheLevelBelow) {
  EXPECT_EQ(names_of(level_without(Level::kRobust, {"blocks", "lobe"})),
            names_of(level_without(Level::kStandard, {})));
  EXPECT_EQ(names_of(level_without(Level::kReference, {"gates", "relief", "choice", "rounds", "second lobe",
                                                       "comparison", "correction"})),
            names_of(level_without(Level::kRobust, {})));
}

TEST(Stages, OfRobustLeftOutLeaveTheBytesOfStandard) {
  const Photographs photographs = glossy_dimples();
  const SolvedFrameMaps standard = solved_by(level_without(Level::kStandard, {}), photographs);
  const SolvedFrameMaps robust = solved_by(level_without(Level::kRobust, {}), photographs);
  const SolvedFrameMaps left = solved_by(level_without(Level::kRobust, {"blocks", "lobe"}), photographs);
  EXPECT_FALSE(are_same(standard, robust)) << "there is a lobe to find";
  EXPECT_TRUE(are_same(standard, left));
  EXPECT_FALSE(left.facts.gloss);
  EXPECT_FALSE(left.facts.robust_share);
}

TEST(Stages, EachCanBeLeftOutByItself) {
  const Photographs photographs = glossy_dimples();
  const SolvedFrameMaps robust = solved_by(level_without(Level::kRobust, {}), photographs);
  ASSERT_TRUE(robust.facts.gloss->is_measured());
  const SolvedFrameMaps matt = solved_by(level_without(Level::kRobust, {"lobe"}), photographs);
  EXPECT_FALSE(matt.facts.gloss);
  EXPECT_EQ(matt.facts.robust_share, robust.facts.robust_share);
  EXPECT_FALSE(are_same(robust, matt));
  const SolvedFrameMaps unchecked = solved_by(level_without(Level::kRobust, {"check"}), photographs);
  EXPECT_FALSE(unchecked.facts.left_out);
  EXPECT_TRUE(are_same(robust, unchecked));
}

TEST(Stages, OfReferenceWithoutAReliefLeaveTheBytesOfRobust) {
  const Photographs photographs = glossy_dimples();
  const std::vector<Stage> forced = level_without(Level::kReference, {"gates", "choice", "comparison"});
  const SolvedFrameMaps robust = solved_by(level_without(Level::kRobust, {}), photographs);
  const SolvedFrameMaps corrected = solved_by(forced, photographs);
  const SolvedFrameMaps left = solved_by(without("relief", forced), photographs);
  EXPECT_FALSE(are_same(robust, corrected)) << "light is taken out whether it is there or not";
  EXPECT_GE(corrected.facts.reference->rounds.size(), 2U);
  EXPECT_TRUE(are_same(robust, left));
  const SolvedFrameMaps once = solved_by(without("rounds", forced), photographs);
  EXPECT_EQ(once.facts.reference->rounds.size(), 1U) << "the first relief stands";
}

TEST(Stages, CanBePutAnywhere) {
  const Photographs photographs = glossy_dimples();
  std::vector<Stage> stages = level_without(Level::kStandard, {});
  int bands = 0;
  stages.insert(stages.begin() + 1, {"count", "counts bands on their way out", {}, [&](Solving& s) {
                                       s.sink = [&bands, next = s.sink](const MapBand& band) {
                                         ++bands;
                                         return next(band);
                                       };
                                       return Result<void>();
                                     }});
  const SolvedFrameMaps counted = solved_by(stages, photographs);
  EXPECT_EQ(counted.maps.rows, kGlossyFrame.height);
  EXPECT_GE(bands, 3);
}

}  // namespace
}  // namespace weft::solve
