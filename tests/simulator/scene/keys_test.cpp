// SPDX-License-Identifier: Apache-2.0
// Keys that mean more than one number, and the refusals of each section.
#include "tests/simulator/scene/scenes.h"

namespace weft::simulator {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(SceneEffects, AreASectionOfFlagsOrAListOfNames) {
  const Scene flags = parsed("[effects]\nnear_light = true\nnoise = true\nbloom = false\n");
  EXPECT_EQ(parsed("effects = [\"near_light\", \"noise\"]\n"), flags);
  EXPECT_EQ(parsed("effects = []\n"), Scene());
  EXPECT_THAT(
      refusal("seed = 1\neffects = [\"noise\", \"vigneting\"]\n"),
      AllOf(HasSubstr("scene.toml:2"), HasSubstr("\"vigneting\" is no effect"), HasSubstr("\"vignetting\"")));
  for (const char* wrong : {"effects = [1]\n", "effects = true\n", "[[effects]]\nnoise = true\n"})
    EXPECT_THAT(refusal(wrong), HasSubstr("a list of names or \"auto\"")) << wrong;
  EXPECT_THAT(refusal("effects = \"noise\"\n"), HasSubstr("in brackets"));
}

TEST(SceneEffects, AreChosenByWhatTheyChangeWhereTheyAreAuto) {
  EXPECT_EQ(parsed("").auto_to_sigma, std::nullopt);
  EXPECT_EQ(parsed("effects = \"auto\"\n").auto_to_sigma, 0.25);
  const Scene scene = parsed("to = \"1.5 sigma\"\neffects = \"auto\"\n");
  EXPECT_EQ(scene.auto_to_sigma, 1.5);
  EXPECT_EQ(parsed(to_toml(scene)), scene) << to_toml(scene);
  EXPECT_THAT(refusal("to = \"1 sigma\"\n"),
              AllOf(HasSubstr("\"to\" cannot"), HasSubstr("effects = \"auto\"")));
  EXPECT_THAT(refusal("to = \"1 sigma\"\n[effects]\nnoise = true\n"), HasSubstr("effects = \"auto\""));
  for (const char* to :
       {"1", "\"1\"", "\"sigma\"", "\"1 sigmas\"", "\"1 sigma \"", "\" 1 sigma\"", "\"one sigma\""}) {
    EXPECT_THAT(refusal("effects = \"auto\"\nto = " + std::string(to) + "\n"), HasSubstr("\"0.25 sigma\""))
        << to;
  }
  for (const char* to : {"0", "-1", "0.0009", "101", "inf", "nan", "1e-300"}) {
    EXPECT_THAT(refusal("effects = \"auto\"\nto = \"" + std::string(to) + " sigma\"\n"),
                HasSubstr("is not between 0.001 and 100"))
        << to;
  }
}

TEST(SceneGeometry, StartsFromAFamilyAndOverridesIt) {
  EXPECT_EQ(parsed("[geometry]\nfamily = \"smooth\"\n").geometry, family_settings(Family::kSmooth));
  EXPECT_EQ(parsed("[geometry]\nfamily = \"plain\"\n").geometry, family_settings(Family::kPlain));
  GeometrySettings deep = family_settings(Family::kDeep);
  deep.twist_relief = 0.02;
  deep.warp_pitch_mm = 1;
  const Scene scene = parsed("[geometry]\nwarp_pitch_mm = 1\ntwist_relief = 0.02\nfamily = \"deep\"\n");
  EXPECT_EQ(scene.geometry, deep) << "whatever the order of the lines";
  EXPECT_THAT(to_toml(scene), testing::Not(HasSubstr("family")));
  EXPECT_EQ(parsed("[geometry]\nfamily = \"deep\"\nkind = \"twill\"\n").geometry.kind, GeometryKind::kTwill);
  EXPECT_THAT(refusal("[geometry]\nfamily = \"deep\"\nkind = \"knit\"\n"), HasSubstr("it is a weave"));
  EXPECT_THAT(refusal("[geometry]\nfamily = \"rough\"\n"), HasSubstr("\"smooth\", \"plain\", \"deep\""));
}

TEST(SceneGeometry, HasFoldsAndWavesOnAnyKind) {
  const Scene scene =
      parsed("[[geometry.fold]]\namplitude_mm = 2\n[[geometry.fold]]\n[[geometry.wave]]\nphase_deg = 9\n");
  ASSERT_EQ(scene.geometry.folds.size(), 2U);
  EXPECT_EQ(scene.geometry.folds[0].amplitude_mm, 2);
  EXPECT_EQ(scene.geometry.folds[1], Fold());
  EXPECT_EQ(scene.geometry.waves.at(0).phase_deg, 9);
}

TEST(SceneMaterial, TakesReflectanceAndColourOfAPreset) {
  const Scene satin = parsed("[material]\npreset = \"satin\"\n");
  EXPECT_EQ(std::get<AnisotropicGgx>(satin.material.reflectance).alpha, 0.45);
  EXPECT_EQ(satin.material.albedo, (Rgb{0.45, 0.4, 0.36}));
  const Scene red = parsed(
      "[material]\npreset = \"satin\"\nalbedo = [0.5, 0.1, 0.1]\n"
      "[material.reflectance]\nanisotropy = 0.25\n");
  EXPECT_EQ(red.material.albedo, (Rgb{0.5, 0.1, 0.1})) << "the scene's own";
  EXPECT_EQ(std::get<AnisotropicGgx>(red.material.reflectance).alpha, 0.45);
  EXPECT_EQ(std::get<AnisotropicGgx>(red.material.reflectance).anisotropy, 0.25);
  EXPECT_THAT(refusal("[material]\n\npreset = \"sattin\"\n"),
              AllOf(HasSubstr("scene.toml:3"), HasSubstr("satin")));
}

TEST(SceneMaterial, HasTheKeysOfItsModelAlone) {
  const Scene scene = parsed("[material.reflectance]\nmodel = \"ggx\"\nalpha = 0.2\nbeneath = \"coupled\"\n");
  EXPECT_EQ(std::get<Ggx>(scene.material.reflectance), (Ggx{0.2, {0.04, 0.04, 0.04}, Beneath::kCoupled}));
  EXPECT_THAT(refusal("[material.reflectance]\nmodel = \"oren_nayar\"\nalpha = 0.2\n"),
              AllOf(HasSubstr("material.reflectance.alpha"), HasSubstr("nearest")));
  EXPECT_THAT(refusal("[material.reflectance]\nmodel = \"phong\"\n"), HasSubstr("\"blinn_phong\""));
}

TEST(SceneTargets, HaveTheKeysOfTheirKindAlone) {
  const Scene scene =
      parsed("[[target]]\n[[target]]\nkind = \"tag\"\nid = 4\n[target.sheet]\ngrain_percent = 2\n");
  ASSERT_EQ(scene.targets.size(), 2U);
  EXPECT_EQ(scene.targets[0], TargetSettings());
  EXPECT_EQ(std::get<TagSettings>(scene.targets[1].pattern).id, 4);
  EXPECT_EQ(scene.targets[1].sheet.grain_percent, 2);
  EXPECT_THAT(refusal("[[target]]\nkind = \"paper\"\nsquares_x = 4\n"), HasSubstr("target[1].squares_x"));
  EXPECT_THAT(refusal("[[target]]\nkind = \"tag\"\ndictionary = \"DICT_9X9\"\n"), HasSubstr("DICT_9X9"));
  EXPECT_THAT(refusal("[[target]]\nkind = \"charuco\"\nsquares_x = 90\nsquares_y = 90\n"),
              AllOf(HasSubstr("target[1].kind"), HasSubstr("scene.toml:2")));
}

TEST(SceneKeys, AreRefusedOutOfTheirRange) {
  for (const std::string scene : {"[camera]\nlinearity = [0.9, -0.9]\n",
                                  "[camera]\nlinearity = [0.1]\n",
                                  "[camera.pose]\ntilt_deg = 81\n",
                                  "[camera.lens]\nk1 = 11\n",
                                  "[camera.movement]\nsigma_deg = 46\n",
                                  "[camera.vignette]\ncosine_power = 8.1\n",
                                  "[camera.vignette]\ncorner_loss = 0.51\n",
                                  "[camera.blur]\nhalo_radius_px = 0.5\n",
                                  "[camera.field]\ncorner_px = 17\n",
                                  "[camera.chromatic]\nblue_px = -11\n",
                                  "[camera.veil]\nshare = 0.21\n",
                                  "[camera.veil]\nspread = 0.04\n",
                                  "[material.translucency]\nshare = 0.91\n",
                                  "[material.translucency]\nmean_mm = 0\n",
                                  "[camera.bloom]\ndecay = 0.95\n",
                                  "[camera.defects]\ncell_counts = [1, 2, 3]\n",
                                  "[camera.defects]\ndead_response = 1\n",
                                  "[geometry]\nkind = \"plain\"\nflatness = 0.91\n",
                                  "[geometry]\nkind = \"plain\"\nfibre_relief = 0.06\n",
                                  "[geometry]\nkind = \"plain\"\nfibre_seed = -1\n",
                                  "[geometry]\nkind = \"knit\"\ncourse_mm = 2.1\n",
                                  "[geometry]\nkind = \"knit\"\nyarn_diameter = 1.1\n",
                                  "[geometry]\nkind = \"sphere\"\ncontact_deg = 90\n",
                                  "[geometry]\nkind = \"cylinder\"\nradius_mm = 0\n",
                                  "[[geometry.fold]]\nsharpness = 0\n",
                                  "[[geometry.fold]]\nwavelength_mm = 0\n",
                                  "[[geometry.wave]]\namplitude_mm = 1001\n",
                                  "[geometry]\nkind = \"height_map\"\n[geometry.height_map]\nfile = \"\"\n",
                                  "[material.print]\nmm_per_sample = 0\n",
                                  "[material.reflectance]\nmodel = \"ggx\"\nalpha = 1.1\n",
                                  "[material.reflectance]\nmodel = \"cloth\"\namplitude = -1\n",
                                  "[material.reflectance]\nmodel = \"oren_nayar\"\nsigma = 1.6\n",
                                  "[spectra]\nled = [0.1, 0.2]\n",
                                  "[spectra]\nled = 1\n",
                                  "[spectra]\nfilters = [\"a.txt\"]\n",
                                  "[spectra]\nchart = []\n",
                                  "[transport]\nshadow_rays = 0\n",
                                  "[transport]\nbounces = 65\n",
                                  "[[target]]\nwidth_mm = 0\n",
                                  "[[target]]\ntilt_deg = 86\n",
                                  "[[target]]\nkind = \"grey_scale\"\nreflectances = []\n",
                                  "[[target]]\n[target.sheet]\nnon_lambertian = -0.6\n"}) {
    EXPECT_THAT(refusal(scene), HasSubstr("cannot be used: scene.toml:")) << scene;
  }
  EXPECT_THAT(refusal("[geometry]\nkind = \"height_map\"\n"), HasSubstr("a picture of heights was expected"));
  EXPECT_THAT(refusal("[material.print]\nmm_per_sample = 2\n"), HasSubstr("a picture to print was expected"));
}

}  // namespace
}  // namespace weft::simulator
