// SPDX-License-Identifier: Apache-2.0
#include "simulator/scene/scene.h"

#include <memory>
#include <set>
#include <sstream>

#include "tests/simulator/scene/scenes.h"

namespace weft::simulator {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// The lines of a scene as TOML, each with the heading of its section.
std::set<std::string> lines_of(const Scene& scene) {
  std::set<std::string> lines;
  std::istringstream toml(to_toml(scene));
  std::string heading;
  for (std::string line; std::getline(toml, line);) {
    if (line.starts_with("[")) heading = line;
    if (line.find(" = ") != line.npos) lines.insert(heading + " " + line);
  }
  return lines;
}

TEST(Scene, IsValidByDefault) {
  EXPECT_TRUE(check_scene(Scene())) << check_scene(Scene()).error().message();
  EXPECT_EQ(parsed(""), Scene());
}

TEST(Scene, NamesNoEffectByDefault) {
  for (const EffectKey& effect : effect_keys()) EXPECT_FALSE(Scene().effects.*effect.on) << effect.name;
}

TEST(Scene, IsTheSameAfterWritingAndReading) {
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    const Scene scene = everything(i);
    EXPECT_EQ(parsed(to_toml(scene)), scene) << to_toml(scene);
    EXPECT_EQ(to_toml(parsed(to_toml(scene))), to_toml(scene));
  }
}

TEST(Scene, IsWrittenWithoutASettingLeftOut) {
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    Scene plain;
    plain.geometry.kind = kKinds[i];
    plain.material.reflectance = kModels[i];
    const std::set<std::string> by_default = lines_of(plain);
    for (const std::string& line : lines_of(everything(i))) {
      if (line.find(" kind = ") != line.npos || line.find(" model = ") != line.npos) continue;
      if (i % 2 == 1 && line.find(" albedo = ") != line.npos) continue;      // there is a dye
      if (!is_woven(kKinds[i]) && line.find("yarn") != line.npos) continue;  // there are none
      if (line.find(" frames = ") != line.npos) continue;  // developed ones bar some effects: see below
      EXPECT_EQ(by_default.count(line), 0U) << "the round trip proves nothing for " << line;
    }
  }
}

TEST(Scene, OfDevelopedFramesIsTheSameAfterWritingAndReading) {
  const Scene scene = parsed("frames = \"exr\"\n[[damage]]\nkind = \"missing\"\nlast_led = 3\ntop = 0.5\n");
  EXPECT_EQ(scene.frames, FrameFormat::kExr);
  ASSERT_EQ(scene.damage.size(), 1U);
  EXPECT_EQ(scene.damage[0], (DamageSettings{DamageKind::kMissing, 1, 3, 0, 1, 0.5, 1, 12}));
  EXPECT_EQ(parsed(to_toml(scene)), scene);
}

TEST(Scene, MadeInCodeIsCheckedAsAWrittenOneIs) {
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    Scene scene = everything(i);
    EXPECT_THAT(check_scene(scene).error().message(), HasSubstr("has not been read"));
    scene.material.print.albedo = std::make_shared<const Image<float>>(Size{4, 4}, 3);
    if (kKinds[i] == GeometryKind::kHeightMap) {
      EXPECT_THAT(check_scene(scene).error().message(), HasSubstr("it has no heights"));
      scene.geometry.heights_mm = std::make_shared<const Image<float>>(Size{4, 4});
    }
    EXPECT_TRUE(check_scene(scene)) << check_scene(scene).error().message();
    scene.camera.defects.dead_response = 0.91;
    EXPECT_THAT(check_scene(scene).error().message(), HasSubstr("camera.defects.dead_response"));
  }
}

TEST(Scene, ReadsWholeNumbersAndOneGreyWhereNumbersAreMeant) {
  const Scene scene = parsed("[camera]\ndistance_mm = 700\n[material]\nalbedo = 1\n");
  EXPECT_EQ(scene.camera.distance_mm, 700);
  EXPECT_EQ(scene.material.albedo, (Rgb{1, 1, 1}));
}

TEST(Scene, RefusesAnUnknownKeyAndNamesTheNearest) {
  EXPECT_THAT(refusal("fabric = \"x\"\n[camera]\nheight = 20\nmm_per_pixels = 1\n"),
              AllOf(HasSubstr("unknown key \"camera.mm_per_pixels\""), HasSubstr("scene.toml:4"),
                    HasSubstr("\"mm_per_pixel\"")));
  EXPECT_THAT(refusal("[efects]\nnoise = true\n"), AllOf(HasSubstr("\"efects\""), HasSubstr("\"effects\"")));
  EXPECT_THAT(
      refusal("[[lights.led]]\nposition_mm = [0, 0, 500]\n[[lights.led]]\npositoin_mm = [0, 0, 500]\n"),
      AllOf(HasSubstr("lights.led[2].positoin_mm"), HasSubstr("scene.toml:4"), HasSubstr("\"position_mm\"")));
}

TEST(Scene, RefusesAKeyThatMeansNothingForItsGeometry) {
  EXPECT_THAT(refusal("[geometry]\nkind = \"twill\"\ntilt_deg = 10\n"), HasSubstr("geometry.tilt_deg"));
  EXPECT_THAT(refusal("[geometry]\nkind = \"plain\"\nover = 2\n"), HasSubstr("geometry.over"));
  EXPECT_THAT(refusal("[material]\nwarp_albedo = 0.3\n"), HasSubstr("colours for yarns"));
}

TEST(Scene, RefusesTheWrongTypeWithItsLine) {
  EXPECT_THAT(refusal("[camera]\nwidth = 12.5\n"),
              AllOf(HasSubstr("camera.width"), HasSubstr("scene.toml:2"), HasSubstr("a whole number")));
  EXPECT_THAT(refusal("[camera]\ndistance_mm = \"600\"\n"), HasSubstr("a number was expected"));
  EXPECT_THAT(refusal("[effects]\nnoise = 1\n"), HasSubstr("true or false"));
  EXPECT_THAT(refusal("fabric = 3\n"), HasSubstr("a text in quotes"));
  EXPECT_THAT(refusal("camera = 3\n"), HasSubstr("a section [camera]"));
  EXPECT_THAT(refusal("[lights]\nled = []\n"), HasSubstr("[[lights.led]]"));
  EXPECT_THAT(refusal("[material]\nalbedo = [0.1, 0.2]\n"), HasSubstr("three numbers"));
  EXPECT_THAT(refusal("[material]\nalbedo = 9007199254740993\n"), HasSubstr("three numbers")) << "no double";
  EXPECT_THAT(refusal("[material]\nalbedo = [0.1, 0.2, \"x\"]\n"), HasSubstr("three numbers"));
  EXPECT_THAT(refusal("[camera]\nbody = \"leica\"\n"),
              AllOf(HasSubstr("\"leica\""), HasSubstr("\"offset\", \"d5100\"")));
}

TEST(Scene, RefusesValuesOutOfRangeAndSaysTheRange) {
  EXPECT_THAT(
      refusal("\n[camera]\nmm_per_pixel = 0\n"),
      AllOf(HasSubstr("camera.mm_per_pixel"), HasSubstr("scene.toml:3"), HasSubstr("between 0.0001 and 10")));
  for (const char* scene : {"[camera]\nwidth = 20002\n",
                            "[camera]\nwidth = 0\n",
                            "[camera]\nheight = -2\n",
                            "[camera]\nwidth = 101\n",
                            "[camera]\nwidth = 9223372036854775807\n",
                            "[camera]\nmm_per_pixel = nan\n",
                            "[camera]\nmm_per_pixel = inf\n",
                            "[camera]\nbits = 13\n",
                            "[camera]\niso = 50\n",
                            "[camera]\nexposure_us = 0\n",
                            "[camera]\nalbedo_at_full = 1.1\n",
                            "[material]\nalbedo = 1.01\n",
                            "[material]\nalbedo = [0.1, -0.2, 0.3]\n",
                            "[geometry]\nkind = \"tilted\"\ntilt_deg = 90\n",
                            "[geometry]\nkind = \"plain\"\nwarp_pitch_mm = 0\n",
                            "[geometry]\nkind = \"plain\"\nflank_deg = 90\n",
                            "[geometry]\nkind = \"plain\"\ncrimp = 0.4\n",
                            "[geometry]\nkind = \"twill\"\nstep = 4\n",
                            "[lights]\nmu = -1\n",
                            "[lights]\nwhite_balance = 0\n",
                            "[[lights.ring]]\ncount = 0\n",
                            "[[lights.led]]\nposition_mm = [0, 0, 500]\naim = [0, 0, 0]\n",
                            "[[damage]]\ntop = 1.1\n",
                            "[[damage]]\nleft = 0.6\nright = 0.5\n",
                            "[[damage]]\nfirst_led = 4\nlast_led = 3\n",
                            "seed = -1\n"}) {
    EXPECT_THAT(refusal(scene),
                AllOf(HasSubstr("cannot be used: scene.toml:"), testing::Not(HasSubstr("nothing was"))))
        << scene;
  }
}

TEST(Scene, AcceptsTheLargestFrames) {
  const Scene scene = parsed("[camera]\nwidth = 20000\nheight = 20000\n");
  EXPECT_EQ(scene.camera.width, 20000);
}

TEST(Scene, ThatIsNotTomlIsRefusedWithItsLine) {
  EXPECT_THAT(refusal("[camera]\nwidth = = 3\n"), AllOf(HasSubstr("not TOML"), HasSubstr("scene.toml:2")));
  EXPECT_THAT(refusal("seed = 1\nseed = 2\n"), HasSubstr("scene.toml:2"));
  EXPECT_THAT(refusal(std::string("fabric = \"\xff\"\n")), HasSubstr("not TOML"));
  EXPECT_THAT(refusal(std::string(100000, '[')), HasSubstr("not TOML"));
}

}  // namespace
}  // namespace weft::simulator
