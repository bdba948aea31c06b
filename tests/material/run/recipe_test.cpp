// SPDX-License-Identifier: Apache-2.0
#include "material/run/recipe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "core/base/files.h"
#include "core/base/temporary_folder.h"

namespace weft::material {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Recipe recipe_of(const std::string& json) {
  Result<Recipe> recipe = recipe_from_json(Json::parse(json), "here");
  EXPECT_TRUE(recipe) << recipe.error().message();
  return recipe ? std::move(*recipe) : Recipe();
}

std::string refusal_of(const std::string& json) {
  const Result<Recipe> recipe = recipe_from_json(Json::parse(json), "here");
  if (recipe) return "was taken";
  EXPECT_EQ(recipe.error().kind, ErrorKind::kBadData);
  return recipe.error().message();
}

TEST(Recipe, HasEveryKeyOfAStepWithItsDefault) {
  const Recipe recipe = recipe_of(R"({"steps": [{"do": "tile"}]})");
  ASSERT_EQ(recipe.steps.size(), 1U);
  EXPECT_EQ(recipe.steps[0].options, Json::parse(R"({"repeats": [0.0, 0.0]})"));
}

TEST(Recipe, IsTheSameFromTomlAndFromJson) {
  const TemporaryFolder folder;
  const std::string toml = R"(
[[step]]
do = "flatten"
by = "high-pass"
cut_mm = 12
[[step]]
do = "tile"
repeats = [4, 3.0]
[[step]]
do = "repair"
spots = [{x_mm = 1, y_mm = 2.5, radius_mm = 0.5}]
)";
  ASSERT_TRUE(write_file(folder.path() / "a.toml", toml));
  const Result<Recipe> from_toml = read_recipe(folder.path() / "a.toml");
  ASSERT_TRUE(from_toml) << from_toml.error().message();
  const Recipe from_json = recipe_of(R"({"steps": [{"do": "flatten", "by": "high-pass", "cut_mm": 12.0},
      {"do": "tile", "repeats": [4.0, 3]}, {"do": "repair", "spots": [{"x_mm": 1.0, "y_mm": 2.5, "radius_mm": 0.5}]}]})");
  EXPECT_EQ(*from_toml, from_json);
  EXPECT_EQ(json_of(*from_toml).dump(), json_of(from_json).dump());
}

TEST(Recipe, ReadsBackWhatItWritesWithTheFactsOfASetOfMaps) {
  const Recipe recipe =
      recipe_of(R"({"steps": [{"do": "crop", "width_mm": 20}, {"do": "color", "exposure": -0.5}]})");
  Json document = json_of(recipe);
  document["schema"] = "weft.maps/1";
  document["steps"][0]["facts"] = {{"width_px", 400}};
  EXPECT_EQ(recipe_of(document.dump()), recipe);
}

TEST(Recipe, TakesKeysOfAStepBesideItsSteps) {
  const Recipe whole = recipe_of(R"({"steps": [{"do": "flatten"},
      {"do": "straighten", "turn_deg": 25, "yarn_px": [12, 10.5]}, {"do": "tile"}]})");
  EXPECT_EQ(recipe_of(R"({"recipe": "tile", "straighten": {"turn_deg": 25, "yarn_px": [12, 10.5]}})"), whole);
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "turned.toml";
  ASSERT_TRUE(write_file(file, "recipe = \"tile\"\nstraighten = { turn_deg = 25, yarn_px = [12, 10.5] }\n"));
  const Result<Recipe> from_toml = read_recipe(file);
  ASSERT_TRUE(from_toml) << from_toml.error().message();
  EXPECT_EQ(*from_toml, whole);
  EXPECT_EQ(recipe_of(R"({"recipe": "tile"})").steps[1].options,
            Json::parse(R"({"turn_deg": null, "yarn_px": [0.0, 0.0]})"));
  EXPECT_THAT(refusal_of(R"({"recipe": "flat", "straighten": {"turn_deg": 25}})"),
              HasSubstr("none of its steps is straighten"));
  EXPECT_THAT(refusal_of(R"({"recipe": "tiel"})"), HasSubstr("must be one of flat, tile, detail"));
  EXPECT_THAT(refusal_of(R"({"recipe": "tile", "straighten": {"turn_deg": 91}})"),
              HasSubstr("must be a number from -90 to 90, or be left out"));
  EXPECT_THAT(refusal_of(R"({"recipe": "tile", "straighten": {"do": "crop"}})"),
              HasSubstr("must be keys of that step"));
}

TEST(Recipe, NamesTheNearestStepAndKey) {
  EXPECT_THAT(refusal_of(R"({"steps": [{"do": "flaten"}]})"),
              AllOf(HasSubstr("step 1"), HasSubstr("the nearest is flatten")));
  EXPECT_THAT(refusal_of(R"({"steps": [{"do": "tile"}, {"do": "tile", "repeat": [1, 1]}]})"),
              AllOf(HasSubstr("step 2: repeat"), HasSubstr("there is no such key; the nearest is repeats")));
}

TEST(Recipe, RefusesValuesThatAreOutOfTheirRangeOrNoneAtAll) {
  for (const char* steps :
       {R"([{"do": "tile", "repeats": [1]}])", R"([{"do": "tile", "repeats": [1, "a"]}])",
        R"([{"do": "tile", "repeats": [-1, 1]}])", R"([{"do": "flatten", "by": "magic"}])",
        R"([{"do": "flatten", "degree": 2.5}])", R"([{"do": "flatten", "cut_mm": 0}])",
        R"([{"do": "flatten", "always": 1}])", R"([{"do": "repair", "spots": [{"x_mm": 1}]}])",
        R"([{"do": "repair", "spots": [1, 2]}])", R"([{"do": 3}])", R"([4])", R"([{"tile": true}])",
        R"(7)"}) {
    EXPECT_THAT(refusal_of(std::string(R"({"steps": )") + steps + "}"), HasSubstr("here")) << steps;
  }
  EXPECT_THAT(refusal_of("[]"), HasSubstr("no list of steps"));
}

TEST(Recipe, ThatWeftBringsAlongIsFoundByItsName) {
  for (const char* name : {"flat", "tile", "detail"}) {
    const Result<Recipe> recipe = read_recipe(name);
    ASSERT_TRUE(recipe) << recipe.error().message();
    EXPECT_FALSE(recipe->steps.empty()) << name;
  }
  const Result<Recipe> none = read_recipe("tiel");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::kNoInput);
  EXPECT_THAT(none.error().message(), HasSubstr("tile"));
}

TEST(Recipe, SaysOfEachStepAndKeyWhatItIs) {
  std::set<std::string> names;
  for (const RecipeStepKind& kind : step_kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_NE(std::string(kind.says), "");
    for (const StepKey& key : kind.keys) EXPECT_NE(std::string(key.says), "") << kind.name << "." << key.name;
  }
}

}  // namespace
}  // namespace weft::material
