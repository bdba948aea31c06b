// SPDX-License-Identifier: Apache-2.0
#include "material/assets/resolve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "tests/material/assets/written.h"

namespace weft::material {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> names_of(const std::vector<MaterialLayer>& layers) {
  std::vector<std::string> names;
  for (const MaterialLayer& layer : layers) names.push_back(layer.name);
  return names;
}

const char* const kBase =
    "name = \"base\"\nsize_mm = [8, 8]\n[surface]\nroughness = 0.6\nalbedo = [0.5, 0.4, 0.3]\n"
    "[[layer]]\nname = \"dirt\"\nmaterial = \"dirt.toml\"\nalpha = 0.5\n"
    "[[layer]]\nname = \"wear\"\nmaterial = \"wear.toml\"\n";

TEST(Resolve, EachValueComesFromTheNearestFileThatSaysIt) {
  const Written files = {
      {"base.toml", kBase},
      {"red.toml", "inherits = \"base.toml\"\n[surface]\nalbedo_tint = [1, 0.1, 0.1]\nroughness = 0.7\n"}};
  const ResolvedMaterial red = resolved(files, "red.toml");
  EXPECT_EQ(red.surface.at("roughness").value, Json::array({0.7}));
  EXPECT_EQ(red.surface.at("roughness").from, "/m/red.toml");
  EXPECT_EQ(red.surface.at("albedo").from, "/m/base.toml");
  EXPECT_EQ(red.top.at("size_mm").from, "/m/base.toml");
  EXPECT_EQ(red.generations.size(), 2U);
  const Json document = json_of(red);
  EXPECT_EQ(document["generations"], Json::array({"/m/red.toml", "/m/base.toml"}));
  EXPECT_THAT(document.dump(), HasSubstr(R"({"key":"layer.dirt.alpha","value":0.5,"from":"/m/base.toml"})"));
}

TEST(Resolve, ChildrenChangeMoveAddAndRemoveLayersByName) {
  const Written files = {{"base.toml", kBase},
                         {"child.toml",
                          "inherits = \"base.toml\"\n"
                          "[[layer]]\nname = \"dirt\"\nalpha = 0.9\n"
                          "[[layer]]\nname = \"moss\"\nmaterial = \"moss.toml\"\nafter = \"dirt\"\n"
                          "[[layer]]\nname = \"snow\"\nmaterial = \"snow.toml\"\n"},
                         {"last.toml",
                          "inherits = \"child.toml\"\n[[layer]]\nname = \"dirt\"\nafter = "
                          "\"snow\"\n[[layer]]\nname = \"wear\"\nremove = true\n"}};
  const ResolvedMaterial child = resolved(files, "child.toml");
  EXPECT_THAT(names_of(child.layers), ElementsAre("dirt", "moss", "wear", "snow"));
  EXPECT_EQ(child.layers[0].values.at("alpha").value, 0.9);
  EXPECT_EQ(child.layers[0].values.at("material").from, "/m/base.toml") << "what a change does not say stays";
  EXPECT_THAT(names_of(resolved(files, "last.toml").layers), ElementsAre("moss", "snow", "dirt"));
}

TEST(Resolve, UnsetTakesOutWhatWasInherited) {
  const Written files = {
      {"base.toml", kBase},
      {"child.toml", "inherits = \"base.toml\"\nunset = [\"surface.roughness\", \"size_mm\"]\n"}};
  const ResolvedMaterial child = resolved(files, "child.toml");
  EXPECT_FALSE(child.surface.contains("roughness"));
  EXPECT_FALSE(child.top.contains("size_mm"));
  EXPECT_TRUE(child.surface.contains("albedo"));
}

TEST(Resolve, AListOverridesAsAWhole) {
  const Written files = {
      {"base.toml", "[[layer]]\nname = \"a\"\nmaterial = \"a.toml\"\nonly = [\"albedo\", \"roughness\"]\n"},
      {"child.toml", "inherits = \"base.toml\"\n[[layer]]\nname = \"a\"\nonly = [\"normal\"]\n"}};
  EXPECT_EQ(resolved(files, "child.toml").layers[0].values.at("only").value, Json::array({"normal"}));
}

TEST(Resolve, SixteenGenerationsAreTheMost) {
  Written files = {{"g0.toml", "[surface]\nroughness = 0.1\n"}};
  for (int i = 1; i <= 16; ++i)
    files["g" + std::to_string(i) + ".toml"] = "inherits = \"g" + std::to_string(i - 1) + ".toml\"\n";
  EXPECT_EQ(resolved(files, "g15.toml").generations.size(), 16U);
  EXPECT_THAT(refused(files, "g16.toml"), HasSubstr("more than 16 generations"));
}

TEST(Resolve, ParentsInACircleAreShown) {
  const Written files = {{"a.toml", "inherits = \"b.toml\"\n"},
                         {"b.toml", "inherits = \"c.toml\"\n"},
                         {"c.toml", "inherits = \"a.toml\"\n"}};
  EXPECT_THAT(refused(files, "a.toml"), HasSubstr("/m/a.toml: inherits: materials inherit in a circle: "
                                                  "/m/a.toml -> /m/b.toml -> /m/c.toml -> /m/a.toml"));
}

TEST(Resolve, SaysWhichLayerIsNotThere) {
  const Written files = {
      {"base.toml", kBase},
      {"remove.toml", "inherits = \"base.toml\"\n[[layer]]\nname = \"dirty\"\nremove = true\n"},
      {"change.toml", "inherits = \"base.toml\"\n[[layer]]\nname = \"dirty\"\nalpha = 1\n"},
      {"after.toml", "inherits = \"base.toml\"\n[[layer]]\nname = \"dirt\"\nafter = \"war\"\n"},
      {"unset.toml", "inherits = \"base.toml\"\nunset = [\"surface.normal\"]\n"},
      {"lost.toml", "inherits = \"nowhere.toml\"\n"}};
  EXPECT_THAT(refused(files, "remove.toml"), HasSubstr("/m/remove.toml: [[layer]] dirty: it is removed, and "
                                                       "there is no layer dirty below; the nearest is dirt"));
  EXPECT_THAT(refused(files, "change.toml"),
              HasSubstr("it names no material, and there is no layer dirty below; the nearest is dirt"));
  EXPECT_THAT(refused(files, "after.toml"), HasSubstr("there is no layer war below; the nearest is wear"));
  EXPECT_THAT(refused(files, "unset.toml"),
              HasSubstr("/m/unset.toml: unset: nothing below sets surface.normal"));
  EXPECT_THAT(refused(files, "lost.toml", ErrorKind::kNoInput),
              HasSubstr("/m/lost.toml: inherits: /m/nowhere.toml"));
}

}  // namespace
}  // namespace weft::material
