// SPDX-License-Identifier: Apache-2.0
#include "material/run/finishing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "tests/material/unwoven.h"
#include "tests/material/weave.h"

namespace weft::material {
namespace {

using testing::HasSubstr;

// What the recipe `tile` with some keys over its own makes of a cloth.
struct Made {
  Surface surface;
  FinishingFacts facts;
};

// Previews go on with a part of so many pixels.
constexpr Size kLarge = {480, 400};
constexpr std::int64_t kPart = 280 * 280;

Made made_of(const WeaveSettings& weave, const std::string& recipe, Size size = {320, 320},
             std::int64_t most_px = 0) {
  Made made;
  made.surface = weave_surface(weave, size);
  const Result<Recipe> read = recipe_from_json(Json::parse(recipe), "here");
  EXPECT_TRUE(read) << read.error().message();
  if (!read) return made;
  Result<FinishingFacts> facts = finish_surface(made.surface, *read, {.most_px = most_px}, {});
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

TEST(Finishing, OfAPartAgreesWithThatOfTheWholeCloth) {
  for (const WeaveSettings& weave :
       {WeaveSettings{.turn_deg = 3, .warp_px = 1, .bow_px = 6},
        WeaveSettings{.binding = kTwill, .turn_deg = -2},
        WeaveSettings{.binding = kSatin5, .pitch_x_px = 11, .pitch_y_px = 9}, kTurned}) {
    SCOPED_TRACE(std::string(weave.binding.name) + " " + std::to_string(weave.turn_deg));
    const Made all = made_of(weave, R"({"recipe": "tile"})", kLarge),
               part = made_of(weave, R"({"recipe": "tile"})", kLarge, kPart);
    ASSERT_EQ(part.facts.steps.size(), 3U);
    for (const char* found : {"acts", "kind", "turn_deg", "skew_deg", "repeat"})
      EXPECT_EQ(part.facts.steps[1][found], all.facts.steps[1][found]) << found;
    EXPECT_EQ(part.facts.steps[2]["has_repeat"], all.facts.steps[2]["has_repeat"]);
    EXPECT_TRUE(part.surface.is_tile);
    EXPECT_LT(part.surface.size().pixels(), kPart);
    EXPECT_TRUE(all.facts.part_mm.empty());
    ASSERT_EQ(part.facts.part_mm.size(), 4U);
    EXPECT_NEAR(part.facts.part_mm[0] * part.facts.part_mm[1] / std::pow(weave.mm_per_pixel, 2), kPart,
                kLarge.width);
    EXPECT_DOUBLE_EQ(part.facts.part_mm[2], kLarge.width * weave.mm_per_pixel);
  }
}

TEST(Finishing, OfAPartDoesStepsThatNamePlacesToAllOfTheCloth) {
  const std::string recipe =
      R"({"steps": [{"do": "straighten"}, {"do": "crop", "left_mm": 12, "top_mm": 1}, {"do": "tile"}]})";
  const Made all = made_of({.turn_deg = 3}, recipe, kLarge),
             part = made_of({.turn_deg = 3}, recipe, kLarge, kPart / 2);
  ASSERT_EQ(part.facts.steps.size(), 3U);
  EXPECT_EQ(part.facts.steps[1], all.facts.steps[1]);
  EXPECT_TRUE(all.surface.is_tile);
  EXPECT_TRUE(part.surface.is_tile);
}

TEST(Finishing, OfAPartHasRoomForTheRepeatsThatAreAskedFor) {
  const std::string recipe = R"({"recipe": "tile", "tile": {"repeats": [16, 4]}})";
  const Made part = made_of({.turn_deg = 3}, recipe, kLarge, kPart / 2);
  ASSERT_EQ(part.facts.steps.size(), 3U);
  const double mm = part.facts.steps[1]["repeat"]["across_mm"].get<double>();
  EXPECT_NEAR(part.surface.size().width * part.facts.steps[1]["mm_per_pixel"][0].get<double>(), 16 * mm,
              1e-6);
}

TEST(Finishing, SaysWhereItsResultLayOnTheCloth) {
  const WeaveSettings weave = {.turn_deg = 8};
  for (const std::int64_t most_px : {std::int64_t{0}, kPart}) {
    const Made made = made_of(weave, R"({"recipe": "tile"})", kLarge, most_px);
    const std::array<double, 8>& c = made.facts.place.corners_px;
    const Size size = made.surface.size();
    EXPECT_NEAR(degrees(std::atan2(c[1] - c[3], c[2] - c[0])), 8, 0.1);
    EXPECT_NEAR(std::hypot(c[2] - c[0], c[3] - c[1]), size.width, 0.02 * size.width);
    EXPECT_NEAR(std::hypot(c[6] - c[0], c[7] - c[1]), size.height, 0.02 * size.height);
    for (const double each : c) EXPECT_TRUE(each > -1 && each < kLarge.width + 1) << each;
    EXPECT_NEAR(made.facts.place.centre_px[0], (c[0] + c[4]) / 2, 1);
    EXPECT_NEAR(made.facts.place.centre_px[1], (c[1] + c[5]) / 2, 1);
  }
}

TEST(Finishing, NamesTheLengthsAndTheAngleOfTheRepeat) {
  const Made made = made_of({.binding = kTwill, .pitch_x_px = 12, .pitch_y_px = 10, .skew_deg = 1},
                            R"({"recipe": "tile"})");
  const Json& repeat = made.facts.steps.at(1)["repeat"];
  EXPECT_NEAR(repeat["across_mm"].get<double>(), 4 * 12 * 0.04, 0.01) << repeat;
  EXPECT_NEAR(repeat["up_mm"].get<double>(), 4 * 10 * 0.04, 0.01) << repeat;
  EXPECT_NEAR(repeat["angle_deg"].get<double>(), 89, 0.1) << repeat;
}

TEST(Finishing, NamesTheOneLengthOfRibs) {
  Surface ribs = corduroy({512, 512}, 23.4, 3.7);
  const Result<FinishingFacts> facts =
      finish_surface(ribs, *recipe_from_json({{"recipe", "tile"}}, "here"), {}, {});
  ASSERT_TRUE(facts) << facts.error().message();
  EXPECT_EQ(facts->steps[1]["kind"], "one-way");
  EXPECT_NEAR(facts->steps[1]["repeat"]["across_mm"].get<double>(), 23.4 * ribs.mm_per_pixel, 0.01);
  EXPECT_FALSE(facts->steps[1]["repeat"].contains("up_mm"));
}

}  // namespace
}  // namespace weft::material
