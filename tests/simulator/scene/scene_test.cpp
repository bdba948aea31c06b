// SPDX-License-Identifier: Apache-2.0
#include "simulator/scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

namespace weft::simulator {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::filesystem::path kSource = WEFT_SOURCE_DIR;

Scene parsed(const std::string& toml) {
  Result<Scene> scene = parse_scene(toml, "scene.toml");
  EXPECT_TRUE(scene) << scene.error().message();
  return scene ? *scene : Scene();
}

std::string refusal(const std::string& toml) {
  const Result<Scene> scene = parse_scene(toml, "scene.toml");
  if (scene) return "nothing was refused";
  EXPECT_EQ(scene.error().kind, ErrorKind::kBadData);
  return scene.error().message();
}

/// A scene in which no value is as it is by default.
Scene everything(GeometryKind kind) {
  Scene s;
  s.fabric = "a \"quoted\" \\ name\twith a tab, caf\xC3\xA9";
  s.seed = std::int64_t{1} << 62;
  s.camera = {640, 480, 1.0 / 3, 700.1, Body::kD5100, 12, 1e5, 2.5, 200, 5.6, 1234.5, 0.3};
  s.geometry.kind = kind;
  s.geometry.cloth_height_mm = 1.5;
  if (kind == GeometryKind::kTilted) s.geometry.tilt_deg = 33, s.geometry.azimuth_deg = -71;
  if (is_woven(kind)) {
    s.geometry.warp_pitch_mm = 0.3;
    s.geometry.weft_pitch_mm = 0.31;
    s.geometry.crimp = 0.05;
    s.geometry.flank_deg = 41;
    s.geometry.twist_relief = 0.01;
    s.material.warp_albedo = Rgb{0.1, 0.2, 0.3};
    s.material.weft_albedo = Rgb{0.4, 0.5, 0.6};
    s.material.stripe_yarns = 3;
    s.material.yarn_variation = 0.02;
  }
  if (kind == GeometryKind::kTwill || kind == GeometryKind::kSatin) {
    s.geometry.over = 3;
    s.geometry.under = 2;
    s.geometry.step = 2;
  }
  s.material.albedo = {0.7, 0.8, 0.9};
  s.lights.flux = 1e7 / 3;
  s.lights.white_balance = {0.4, 1.1, 0.9};
  s.lights.mu = 1.2;
  s.lights.rings = {{3, 40, 5, 500}, {2, 50, 6, 550}};
  s.lights.leds = {{{1, 2, 300}, Vec3{0, 0.1, -1}, 0.0, Rgb{1, 2, 3}}, {{4, 5, 600}, {}, {}, {}}};
  s.effects = {true, true, true};
  return s;
}

const std::vector<GeometryKind> kKinds = {GeometryKind::kFlat, GeometryKind::kTilted, GeometryKind::kPlain,
                                          GeometryKind::kTwill, GeometryKind::kSatin};

TEST(Scene, IsValidByDefault) {
  EXPECT_TRUE(check_scene(Scene())) << check_scene(Scene()).error().message();
  EXPECT_EQ(parsed(""), Scene());
}

TEST(Scene, NamesNoEffectByDefault) {
  EXPECT_EQ(Scene().effects, (EffectSettings{false, false, false}));
}

TEST(Scene, IsTheSameAfterWritingAndReading) {
  for (const GeometryKind kind : kKinds) {
    const Scene scene = everything(kind);
    ASSERT_TRUE(check_scene(scene)) << check_scene(scene).error().message();
    EXPECT_EQ(parsed(to_toml(scene)), scene) << to_toml(scene);
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

TEST(Scene, OfAFileThatIsNotThereIsNoInput) {
  const Result<Scene> none = read_scene(kSource / "testdata" / "scenes" / "none.toml");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::kNoInput);
}

TEST(Scene, OfEachExampleIsValid) {
  int examples = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kSource / "testdata" / "scenes")) {
    if (entry.path().extension() != ".toml") continue;
    const Result<Scene> scene = read_scene(entry.path());
    EXPECT_TRUE(scene) << scene.error().message();
    ++examples;
  }
  EXPECT_GE(examples, 7);
}

TEST(Scene, HasEachOfItsKeysInTheDocumentation) {
  std::ifstream in(kSource / "docs" / "scenes.md");
  const std::string page((std::istreambuf_iterator<char>(in)), {});
  std::set<std::string> keys;
  for (const GeometryKind kind : kKinds) {
    std::istringstream lines(to_toml(everything(kind)));
    for (std::string line; std::getline(lines, line);) {
      if (const std::size_t equals = line.find(" = "); equals != line.npos)
        keys.insert(line.substr(0, equals));
    }
  }
  EXPECT_GT(keys.size(), 40U);
  for (const std::string& key : keys) EXPECT_THAT(page, HasSubstr("`" + key + "`"));
}

}  // namespace
}  // namespace weft::simulator
