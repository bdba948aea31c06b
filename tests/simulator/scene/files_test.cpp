// SPDX-License-Identifier: Apache-2.0
// Files that a scene names: relative to its own folder, refused with the key that names them.
#include <cstdlib>
#include <fstream>
#include <limits>

#include "core/image_io/image_io.h"
#include "simulator/scene/scene_rig.h"
#include "tests/simulator/scene/scenes.h"

namespace weft::simulator {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class SceneFiles : public testing::Test {
 protected:
  SceneFiles() {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "in");
  }
  ~SceneFiles() override { fs::remove_all(folder_); }

  void put(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  Result<Scene> read(const std::string& toml) const {
    put("scene.toml", toml);
    return read_scene(folder_ / "scene.toml");
  }
  std::string refusal_of(const std::string& toml, ErrorKind kind = ErrorKind::kBadData) const {
    const Result<Scene> scene = read(toml);
    if (scene) return "nothing was refused";
    EXPECT_EQ(scene.error().kind, kind) << scene.error().message();
    return scene.error().message();
  }
  void put_picture(const std::string& name, const Image<float>& image,
                   const std::vector<std::string>& channels) const {
    std::vector<View<const float>> planes;
    for (int p = 0; p < image.planes(); ++p) planes.push_back(image.plane(p));
    const Result<void> written = write_image(folder_ / name, planes, channels, {});
    ASSERT_TRUE(written) << written.error().message();
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / "weft_scene_files";
};

std::string table_of(const Spectrum& s) {
  std::string table = "# nm share\n";
  for (std::size_t i = 0; i < Spectrum::kSamples; ++i)
    table += std::to_string(Spectrum::nm(i)) + " " + std::to_string(s.samples[i]) + "\n";
  return table;
}

TEST_F(SceneFiles, ThatAreNotThereAreNoInput) {
  const Result<Scene> none = read_scene(kSource / "testdata" / "scenes" / "none.toml");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::kNoInput);
  for (const char* scene :
       {"[material]\ndye = \"none\"\n", "[spectra]\nled = \"none\"\n", "[spectra]\nchart = \"none\"\n",
        "[lights]\nrig = \"none\"\n", "[material.print]\nfile = \"none\"\n",
        "geometry.kind = \"height_map\"\ngeometry.height_map.file = \"none\"\n"}) {
    EXPECT_THAT(refusal_of(scene, ErrorKind::kNoInput),
                AllOf(HasSubstr("cannot be used: " + (folder_ / "scene.toml:2").string()),
                      HasSubstr((folder_ / "none").string())))
        << scene;
  }
}

TEST_F(SceneFiles, OfSpectraLieBesideTheScene) {
  put("in/dye.txt", table_of(flat_spectrum(0.25)));
  put("bad.txt", "380 2\n");
  const Result<Scene> scene = read(
      "[material]\ndye = \"in/dye.txt\"\n[spectra]\nled = \"in/../in/dye.txt\"\n"
      "filters = [\"in/dye.txt\", \"in/dye.txt\", \"in/dye.txt\"]\n");
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->material.dye, flat_spectrum(0.25));
  EXPECT_EQ(scene->spectra.led, flat_spectrum(0.25));
  EXPECT_EQ(scene->spectra.filters[2], flat_spectrum(0.25));
  EXPECT_EQ(parsed(to_toml(*scene)), *scene) << "the numbers are in the scene that is written";
  EXPECT_THAT(refusal_of("[material]\ndye = \"bad.txt\"\n"),
              AllOf(HasSubstr("material.dye"), HasSubstr("bad.txt:1")));
}

TEST_F(SceneFiles, OfAChartAreAFolder) {
  const Result<Scene> scene =
      read("[spectra]\nchart = \"" + (kSource / "testdata/spectra/chart").string() + "\"\n");
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->spectra.chart.size(), 24U);
}

TEST_F(SceneFiles, OfAMeasuredRigBecomeLeds) {
  put("rig.json", R"({"leds": [
      {"position_mm": [100, -50, 200], "direction": [0, 0, 1], "mu": 2, "flux_rgb": [1, 2, 3]}]})");
  const Result<Scene> scene = read(
      "[camera]\ndistance_mm = 700\n[lights]\nrig = \"rig.json\"\n"
      "[[lights.led]]\nposition_mm = [0, 0, 300]\n");
  ASSERT_TRUE(scene) << scene.error().message();
  ASSERT_EQ(scene->lights.leds.size(), 2U) << "the rig's, then the scene's own";
  EXPECT_EQ(scene->lights.leds[0], (LedSettings{{100, 50, 500}, Vec3{0, 0, -1}, 2.0, Rgb{1, 2, 3}}));
  EXPECT_EQ(scene->lights.leds[1].position_mm.z, 300);
  EXPECT_EQ(parsed(to_toml(*scene)), *scene);
  put("rig.json", "{}");
  EXPECT_THAT(refusal_of("[lights]\nrig = \"rig.json\"\n"),
              AllOf(HasSubstr("lights.rig"), HasSubstr("leds")));
}

TEST_F(SceneFiles, OfThePublishedRigStandAboveTheTable) {
  const char* shared = std::getenv("WEFT_SHARED_DATA");
  if (shared == nullptr) GTEST_SKIP() << "WEFT_SHARED_DATA is not set";
  const Result<Scene> scene = read("[camera]\ndistance_mm = 700\n[lights]\nrig = \"" +
                                   (fs::path(shared) / "near_led_rig.json").string() + "\"\n");
  ASSERT_TRUE(scene) << scene.error().message();
  ASSERT_EQ(scene->lights.leds.size(), 8U);
  for (const LedSettings& led : scene->lights.leds) EXPECT_GT(led.position_mm.z, 150);
}

TEST_F(SceneFiles, OfHeightsAreReadAsTheyAre) {
  Image<float> heights(Size{3, 2});
  heights(2, 1) = -7.25F;
  put_picture("in/heights.exr", heights, {"Y"});
  const Result<Scene> scene = read(
      "[geometry]\nkind = \"height_map\"\n[geometry.height_map]\n"
      "file = \"in/heights.exr\"\nmm_per_sample = 2\nrepeats = false\n");
  ASSERT_TRUE(scene) << scene.error().message();
  const GeometrySettings& g = scene->geometry;
  ASSERT_TRUE(g.heights_mm);
  EXPECT_EQ(g.heights_mm->size(), (Size{3, 2}));
  EXPECT_EQ((*g.heights_mm)(2, 1), -7.25F);
  EXPECT_EQ(g.height_map.mm_per_sample, 2);
  EXPECT_EQ(g.heights_file, (folder_ / "in/heights.exr").string());
  EXPECT_TRUE(check_scene(*scene));
  Scene without = *scene;
  without.geometry.heights_mm = nullptr;
  EXPECT_EQ(parsed(to_toml(*scene)), without);
}

TEST_F(SceneFiles, OfHeightsAreRefusedWhereTheyAreNone) {
  const std::string scene = "[geometry]\nkind = \"height_map\"\n[geometry.height_map]\nfile = \"h.exr\"\n";
  const std::string place = (folder_ / "scene.toml:4").string();
  put_picture("h.exr", Image<float>(Size{3, 2}, 3), {"R", "G", "B"});
  EXPECT_THAT(refusal_of(scene),
              AllOf(HasSubstr("geometry.height_map.file"), HasSubstr(place), HasSubstr("3 planes")));
  for (const float wrong :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Image<float> heights(Size{3, 2});
    heights(1, 1) = wrong;
    put_picture("h.exr", heights, {"Y"});
    EXPECT_THAT(refusal_of(scene),
                AllOf(HasSubstr(place), HasSubstr("column 1, row 1 is not a finite number")));
  }
  Image<float> tower(Size{3, 2});
  tower(0, 0) = 1001;
  put_picture("h.exr", tower, {"Y"});
  EXPECT_THAT(refusal_of(scene), HasSubstr("not between -1000 and 1000 mm"));
  put("h.exr", "no picture");
  EXPECT_THAT(refusal_of(scene), HasSubstr(place));
}

TEST_F(SceneFiles, OfAPrintHaveThreeChannelsOfAlbedo) {
  Image<float> print(Size{2, 2}, 3);
  print(1, 0, 2) = 0.5F;
  put_picture("p.exr", print, {"R", "G", "B"});
  const std::string scene = "[material.print]\nfile = \"p.exr\"\n";
  const Result<Scene> read_back = read(scene);
  ASSERT_TRUE(read_back) << read_back.error().message();
  EXPECT_EQ((*read_back->material.print.albedo)(1, 0, 2), 0.5F);
  print(1, 0, 2) = 1.5F;
  put_picture("p.exr", print, {"R", "G", "B"});
  EXPECT_THAT(refusal_of(scene), AllOf(HasSubstr("material.print.file"), HasSubstr("not between 0 and 1")));
  put_picture("p.exr", Image<float>(Size{2, 2}), {"Y"});
  EXPECT_THAT(refusal_of(scene), HasSubstr("1 planes, not 3"));
}

TEST_F(SceneFiles, OfTheExamplesAreValidScenes) {
  int examples = 0;
  for (const auto& entry : fs::directory_iterator(kSource / "testdata" / "scenes")) {
    if (entry.path().extension() != ".toml") continue;
    const Result<Scene> scene = read_scene(entry.path());
    ASSERT_TRUE(scene) << scene.error().message();
    const Result<SceneRig> rig = rig_of(*scene);
    EXPECT_TRUE(rig) << entry.path() << rig.error().message();
    EXPECT_EQ(parsed(to_toml(*scene)), *scene) << entry.path();
    ++examples;
  }
  EXPECT_GE(examples, 27);
}

}  // namespace
}  // namespace weft::simulator
