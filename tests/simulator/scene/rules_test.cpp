// SPDX-License-Identifier: Apache-2.0
// What the keys of a scene may not say together.
#include "simulator/scene/scene.h"

#include "tests/simulator/scene/scenes.h"

namespace weft::simulator {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string list_of_samples(double share) {
  std::string list;
  for (std::size_t i = 0; i < Spectrum::kSamples; ++i) list += (i > 0 ? ", " : "") + std::to_string(share);
  return "[" + list + "]";
}

std::string spectra_section() {
  const std::string half = list_of_samples(0.5);
  return "[spectra]\nled = " + half + "\nfilters = [" + half + ", " + half + ", " + half + "]\n";
}

/// A scene for each rule that breaks it, in the order of the rules, and one like it that does not.
struct Case {
  std::string broken;
  std::string key;
  std::string word;
  std::string mended;
};

std::vector<Case> cases() {
  const std::string dye = "dye = " + list_of_samples(0.25) + "\n";
  const std::string plain = "[geometry]\nkind = \"plain\"\n[material]\n";
  const std::string chart = "[[target]]\nkind = \"chart\"\n";
  std::string patches = "chart = [";
  for (int i = 0; i < 24; ++i) patches += (i > 0 ? ", " : "") + list_of_samples(0.5);
  patches += "]\n";
  return {
      {"[material]\nwarp_albedo = 0.3\n", "material", "colours for yarns", plain + "warp_albedo = 0.3\n"},
      {"[material.translucency]\nweft_share = 0.3\n", "material.translucency", "warp from weft",
       plain + "[material.translucency]\nweft_share = 0.3\n"},
      {"[material]\n" + dye + "albedo = 0.3\n", "material.dye", "another colour", "[material]\n" + dye},
      {plain + "warp_" + dye + "warp_albedo = 0.3\n", "material.warp_dye", "warp_albedo",
       plain + "warp_" + dye + "weft_albedo = 0.3\n"},
      {plain + "weft_" + dye + "weft_albedo = 0.3\n", "material.weft_dye", "weft_albedo",
       plain + "weft_" + dye + "warp_albedo = 0.3\n"},
      {chart, "target", "spectra.chart", chart + spectra_section() + patches},
      {"effects = \"auto\"\n[[ball]]\n", "ball", "do not know balls", "[[ball]]\n"},
      {"effects = \"auto\"\n[blade]\nled = 1\n", "blade", "do not know blades", "[blade]\nled = 1\n"},
      {"effects = [\"finite_led\"]\n", "effects.finite_led", "near_light",
       "effects = [\"near_light\", \"finite_led\"]\n"},
      {"effects = [\"relief\"]\n", "effects.relief", "near_light",
       "effects = [\"near_light\", \"relief\"]\n"},
      {"effects = [\"vignetting\"]\n", "effects.vignetting", "near_light",
       "effects = [\"near_light\", \"vignetting\"]\n"},
      {"effects = [\"near_light\", \"cast_shadows\"]\n", "effects.cast_shadows", "relief",
       "effects = [\"near_light\", \"relief\", \"cast_shadows\"]\n"},
      {"effects = [\"near_light\", \"interreflection\"]\n", "effects.interreflection", "relief",
       "effects = [\"near_light\", \"relief\", \"interreflection\"]\n"},
      {"effects = [\"spectral\"]\n" + spectra_section(), "effects.spectral", "material.dye",
       "effects = [\"spectral\"]\n" + spectra_section() + "[material]\n" + dye},
      {"effects = [\"spectral\"]\n[material]\n" + dye, "effects.spectral", "[spectra]",
       "effects = [\"spectral\"]\n[material]\n" + dye + spectra_section()},
      {"frames = \"exr\"\neffects = [\"bloom\"]\n", "frames", "photosites",
       "frames = \"exr\"\neffects = [\"noise\"]\n"},
      {"[[damage]]\nkind = \"missing\"\n", "damage", "whole counts",
       "frames = \"exr\"\n[[damage]]\nkind = \"missing\"\n"},
  };
}

TEST(SceneRules, RefuseEachContradictionWithItsKeyAndRemedy) {
  const std::vector<Case> all = cases();
  ASSERT_EQ(all.size(), scene_rules().size()) << "one case a rule";
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(scene_rules()[i].key, all[i].key);
    EXPECT_THAT(refusal(all[i].broken), AllOf(HasSubstr("\"" + all[i].key + "\" cannot be used: scene.toml:"),
                                              HasSubstr(all[i].word), HasSubstr(scene_rules()[i].remedy)));
    parsed(all[i].mended);
  }
}

TEST(SceneRules, NameTheLineOfTheKey) {
  EXPECT_THAT(refusal("seed = 1\n[effects]\nnoise = true\nrelief = true\n"),
              HasSubstr("\"effects.relief\" cannot be used: scene.toml:4: "));
  EXPECT_THAT(refusal("seed = 1\neffects = [\"relief\"]\n"), HasSubstr("scene.toml:2: "));
}

TEST(SceneRules, TakeDyesOfBothSetsOfYarnsForADyeOfTheCloth) {
  const std::string half = list_of_samples(0.5);
  const std::string scene = "effects = [\"spectral\"]\n[geometry]\nkind = \"twill\"\n" + spectra_section() +
                            "[material]\nwarp_dye = " + half;
  EXPECT_THAT(refusal(scene + "\n"), HasSubstr("neither a dye"));
  parsed(scene + "\nweft_dye = " + half + "\n");
}

TEST(SceneRules, HoldForScenesMadeInCode) {
  Scene scene;
  scene.effects.relief = true;
  EXPECT_THAT(check_scene(scene).error().message(), HasSubstr("\"effects.relief\" cannot be used: scene: "));
}

}  // namespace
}  // namespace weft::simulator
