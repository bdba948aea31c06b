// SPDX-License-Identifier: Apache-2.0
#include "material/run/finishing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "tests/material/weave.h"

namespace weft::material {
namespace {

using testing::HasSubstr;

// What the recipe `tile` with some keys over its own makes of a cloth.
struct Made {
  Surface surface;
  FinishingFacts facts;
};

Made made_of(const WeaveSettings& weave, const std::string& recipe, double coarser = 1) {
  Made made;
  made.surface = weave_surface(weave, {320, 320});
  const Result<Recipe> read = recipe_from_json(Json::parse(recipe), "here");
  EXPECT_TRUE(read) << read.error().message();
  if (!read) return made;
  Result<FinishingFacts> facts = finish_surface(made.surface, *read, {.coarser = coarser}, {});
  EXPECT_TRUE(facts) << facts.error().message();
  if (facts) made.facts = std::move(*facts);
  return made;
}

const WeaveSettings kTurned = {.pitch_x_px = 12, .pitch_y_px = 10, .turn_deg = 25};

TEST(Finishing, AsksAboutALargeTurnWithAPictureAndDoesNothing) {
  const Made made = made_of(kTurned, R"({"recipe": "tile"})");
  const Json& found = made.facts.steps.at(1);
  EXPECT_EQ(found["acts"], false);
  EXPECT_NEAR(found["turn_deg"].get<double>(), 25, 0.05);
  EXPECT_NEAR(found["skew_deg"].get<double>(), 0, 0.05);
  EXPECT_NEAR(found["yarn_px"][0].get<double>(), 12, 0.02);
  EXPECT_NEAR(found["yarn_px"][1].get<double>(), 10, 0.02);
  ASSERT_EQ(made.facts.pictures.size(), 1U);
  EXPECT_EQ(made.facts.pictures[0].file, found["picture"]);
  const report::Picture& picture = made.facts.pictures[0].picture;
  for (int away = 20; away <= 200; away += 20) {
    const int x = static_cast<int>(std::lround(picture.width() / 2.0 + away * std::cos(radians(25)))),
              y = static_cast<int>(std::lround(picture.height() / 2.0 - away * std::sin(radians(25))));
    EXPECT_EQ(report::colour_at(picture, x, y), (report::Colour{1.0F, 0.3F, 0.2F})) << x << ", " << y;
  }
  ASSERT_EQ(made.facts.verdicts.size(), 2U);
  EXPECT_EQ(made.facts.verdicts[0].name, "TURN_ASKED");
  EXPECT_THAT(made.facts.verdicts[0].text, HasSubstr("turned by 25.00 degrees"));
  EXPECT_THAT(made.facts.verdicts[0].remedy,
              HasSubstr("straighten = { turn_deg = 25.00, yarn_px = [12.00, 10.00] }"));
  EXPECT_EQ(made.facts.verdicts[1].name, "NOT_STRAIGHTENED");
}

TEST(Finishing, DoesWhatTheRemedyOfALargeTurnSays) {
  const Made made =
      made_of(kTurned, R"({"recipe": "tile", "straighten": {"turn_deg": 25.00, "yarn_px": [12.00, 10.00]}})");
  const Json& found = made.facts.steps.at(1);
  EXPECT_EQ(found["acts"], true) << found;
  EXPECT_NEAR(found["turn_deg"].get<double>(), 25, 0.05);
  for (const Verdict& verdict : made.facts.verdicts) EXPECT_NE(verdict.name, "TURN_ASKED");
  EXPECT_TRUE(made.facts.pictures.empty());
  EXPECT_TRUE(made.facts.steps.at(2)["has_repeat"].get<bool>());
}

TEST(Finishing, AsksAboutALargeShear) {
  const Made made =
      made_of({.pitch_x_px = 12, .pitch_y_px = 10, .turn_deg = 1, .skew_deg = 5}, R"({"recipe": "tile"})");
  ASSERT_FALSE(made.facts.verdicts.empty());
  EXPECT_EQ(made.facts.verdicts[0].name, "TURN_ASKED");
  EXPECT_NEAR(made.facts.steps.at(1)["skew_deg"].get<double>(), -5, 0.1);
}

TEST(Finishing, StraightensASmallTurnUnasked) {
  const Made made = made_of({.turn_deg = 8, .tone = 0}, R"({"recipe": "tile"})");
  EXPECT_EQ(made.facts.steps.at(1)["acts"], true);
  EXPECT_NEAR(made.facts.steps.at(1)["turn_deg"].get<double>(), 8, 0.05);
}

TEST(Finishing, TakesWidthsInPixelsOfTheFullSizeInAPreviewToo) {
  const std::string recipe = R"({"recipe": "tile", "straighten": {"turn_deg": 25, "yarn_px": [48, 40]}})";
  EXPECT_EQ(made_of(kTurned, recipe, 4).facts.steps.at(1)["acts"], true);
}

}  // namespace
}  // namespace weft::material
