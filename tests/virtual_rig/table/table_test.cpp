// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/table/table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "simulator/scene/scene_rig.h"
#include "tests/virtual_rig/small_scene.h"
#include "virtual_rig/table/knock.h"

namespace weft::virtual_rig {
namespace {

using simulator::TargetSettings;
using testing::HasSubstr;

RigTable small_table() {
  Result<RigTable> table = RigTable::of(small_scene());
  if (!table) throw std::runtime_error(table.error().message());
  return std::move(*table);
}

TEST(RigTable, HasTheClothUntilSomethingElseIsLaidOnIt) {
  const RigTable table = small_table();
  const Result<simulator::Scene> cloth = table.with({"cloth"});
  ASSERT_TRUE(cloth) << cloth.error().message();
  EXPECT_EQ(*cloth, small_scene());
  const Result<simulator::Scene> empty = table.with({"empty"});
  ASSERT_TRUE(empty) << empty.error().message();
  EXPECT_FALSE(empty->effects.relief);
}

TEST(RigTable, TiltsABoardOnItsLowestCorner) {
  const Result<simulator::Scene> scene =
      small_table().with({"board", "tilt=30", "azimuth=90", "x=5", "height=2"});
  ASSERT_TRUE(scene) << scene.error().message();
  const TargetSettings& board = scene->targets.front();
  EXPECT_EQ(kind_of(board.pattern), simulator::TargetKind::kCharuco);
  EXPECT_EQ(board.tilt_deg, 30);
  EXPECT_EQ(board.azimuth_deg, 90);
  EXPECT_EQ(board.centre_mm.x, 5);
  const auto& squares = std::get<simulator::CharucoSettings>(board.pattern);
  const double half_mm = squares.squares_y * squares.square_mm / 2 + squares.margin_mm;
  EXPECT_NEAR(board.centre_mm.z, 3 + 2 + half_mm * 0.5, 1e-9);  // sin 30 degrees
}

TEST(RigTable, LaysTheSameSheetOrAnotherOne) {
  const RigTable table = small_table();
  const Result<simulator::Scene> same = table.with({"sheet"}), other = table.with({"sheet", "other=1"});
  ASSERT_TRUE(same && other);
  EXPECT_EQ(kind_of(same->targets.front().pattern), simulator::TargetKind::kPaper);
  EXPECT_EQ(kind_of(other->targets.front().pattern), simulator::TargetKind::kTag);
}

TEST(RigTable, RefusesWhatItDoesNotKnowWithWhatItDoes) {
  struct Case {
    std::vector<std::string> words;
    const char* says;
  };
  for (const Case& c : {Case{{"stone"}, "ruler"}, Case{{}, "cloth"}, Case{{"board", "tilt=90"}, "0 to 80"},
                        Case{{"board", "tilt"}, "azimuth=NUMBER"}, Case{{"board", "x=1e9"}, "10000"},
                        Case{{"trap", "x=1"}, "nothing"}, Case{{"chart"}, "spectra"},
                        Case{{"cloth", "/nowhere.toml"}, "nowhere"}}) {
    const Result<simulator::Scene> scene = small_table().with(c.words);
    ASSERT_FALSE(scene) << testing::PrintToString(c.words);
    EXPECT_THAT(scene.error().message(), HasSubstr(c.says));
  }
}

TEST(Knock, MovesCameraLedsAndTableFromWhereTheyWereAtTheStart) {
  Knocks knocks;
  ASSERT_TRUE(knock(knocks, {"camera", "x=9"}, 10));
  ASSERT_TRUE(knock(knocks, {"camera", "x=3", "turn=0.4", "tilt=1", "azimuth=90"}, 10));
  ASSERT_TRUE(knock(knocks, {"led", "2", "z=-4"}, 10));
  ASSERT_TRUE(knock(knocks, {"table", "x=1", "z=-2"}, 10));
  simulator::Scene before = small_scene();
  before.targets.emplace_back();
  const Result<simulator::SceneRig> there = rig_of(before);
  ASSERT_TRUE(there) << there.error().message();
  const Result<simulator::Scene> after = knocked(before, knocks);
  ASSERT_TRUE(after) << after.error().message();
  EXPECT_EQ(after->camera.pose.x_mm, before.camera.pose.x_mm + 3);
  EXPECT_EQ(after->camera.pose.roll_deg, before.camera.pose.roll_deg + 0.4);
  EXPECT_NEAR(after->camera.pose.tilt_deg, 1, 1e-12);
  EXPECT_NEAR(after->camera.pose.azimuth_deg, 90, 1e-9);
  ASSERT_EQ(after->lights.leds.size(), there->leds.leds.size());
  EXPECT_EQ(after->lights.leds[0].position_mm.z, there->leds.leds[0].position_mm.z);
  EXPECT_EQ(after->lights.leds[1].position_mm.z, there->leds.leds[1].position_mm.z - 4);
  EXPECT_EQ(after->geometry.cloth_height_mm, before.geometry.cloth_height_mm - 2);
  EXPECT_EQ(after->targets.back().centre_mm, (before.targets.back().centre_mm + Vec3{1, 0, -2}));
  ASSERT_TRUE(knock(knocks, {"nothing"}, 10));
  EXPECT_EQ(*knocked(before, knocks), before);
}

TEST(Knock, RefusesWhatCannotBe) {
  struct Case {
    std::vector<std::string> words;
    const char* says;
  };
  Knocks knocks;
  for (const Case& c :
       {Case{{}, "camera"}, Case{{"stone"}, "camera"}, Case{{"led"}, "1 to 3"}, Case{{"led", "4"}, "1 to 3"},
        Case{{"led", "1", "x"}, "x=NUMBER"}, Case{{"camera", "tilt=80"}, "0 to 45"}}) {
    const Result<void> done = knock(knocks, c.words, 3);
    ASSERT_FALSE(done) << testing::PrintToString(c.words);
    EXPECT_THAT(done.error().message(), HasSubstr(c.says));
  }
  EXPECT_EQ(knocks, Knocks());
  knocks.leds_mm[1] = {0, 0, -900};
  EXPECT_THAT(knocked(small_scene(), knocks).error().message(), HasSubstr("not above"));
}

}  // namespace
}  // namespace weft::virtual_rig
