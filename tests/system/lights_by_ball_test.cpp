// SPDX-License-Identifier: Apache-2.0
// `weft lights --ball`: from a folder of photographs without a light file to a solve.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/image_io/image_io.h"
#include "core/rig/session.h"
#include "simulator/scene/scene_rig.h"
#include "simulator/simulate.h"
#include "tests/system/program.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

constexpr double kWidth_mm = 160, kPixel_mm = 0.5, kDistance_mm = 600;

class LightsByBall : public testing::Test {
 protected:
  // As float files shot02.exr to shot11.exr.
  simulator::Scene photograph(const fs::path& folder, bool with_ball) const {
    simulator::Scene scene = twill_with_ball(kDistance_mm);
    if (!with_ball) scene.balls.clear();
    write_photographs(scene, folder, SampleType::kFloat);
    return scene;
  }
  static void expect_true(const Json& told, const simulator::Scene& scene) {
    const auto truth =
        simulator::distant_lights(*simulator::rig_of(scene), scene.geometry.cloth_height_mm).lights;
    ASSERT_EQ(told["lights"].size(), truth.size()) << told;
    for (std::size_t k = 0; k < truth.size(); ++k) {
      const Json& d = told["lights"][k]["direction"];
      EXPECT_LT(angle_deg({d[0], d[1], d[2]}, truth[k].direction), 0.3) << k;
    }
  }
  std::vector<std::string> lights(std::vector<std::string> more) const {
    const std::string fov = fmt::format("{}", degrees(2 * std::atan(kWidth_mm / 2 / kDistance_mm)));
    std::vector<std::string> words = {"lights", (work_ / "cloth").string(), "--fov", fov};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  Workspace work_;
};

TEST_F(LightsByBall, AFolderWithABallAndNoLightFileIsSolvedWithoutTheBall) {
  const simulator::Scene scene = photograph(work_ / "cloth", true);
  const Outcome told = run_weft(lights({"--json", "--ball"}));
  ASSERT_EQ(told.exit_code, 0) << told.error;
  expect_true(told.json(), scene);
  EXPECT_TRUE(fs::exists(work_ / "cloth" / "balls.png"));
  const Result<LoadedImage> mask = read_image(work_ / "cloth" / "mask.png");
  ASSERT_TRUE(mask) << mask.error().message();
  EXPECT_EQ(mask->planes(201, 145), 0) << "the ball's middle";
  EXPECT_EQ(mask->planes(40, 40), 1);
  const Outcome solve = run_weft({"solve", "--photos", (work_ / "cloth").string(), "-o",
                                  (work_ / "maps").string(), "--no-previews", "-q"});
  ASSERT_EQ(solve.exit_code, 0) << solve.error;
  // What is there stays.
  const Outcome again = run_weft(lights({"--ball"}));
  EXPECT_EQ(again.exit_code, 73) << again.error;
  EXPECT_THAT(again.error, testing::HasSubstr("lights.lp"));
}

TEST_F(LightsByBall, AnImportedFolderIsASessionWithTheLightsOfItsBall) {
  photograph(work_ / "cloth", true);
  const fs::path session = work_ / "archive" / "cloth.weft";
  const Outcome imported = run_weft(
      {"import", (work_ / "cloth").string(), "-o", (work_ / "archive").string(), "--ball", "--yes", "-q"});
  ASSERT_EQ(imported.exit_code, 0) << imported.error;
  EXPECT_FALSE(fs::exists(work_ / "cloth" / "lights.lp")) << "photographs are opened for reading alone";
  for (const char* file : {"balls.png", "photographs/mask.png", "photographs/lights.lp"})
    EXPECT_TRUE(fs::exists(session / file)) << file;
  ASSERT_EQ(run_weft(lights({"--ball"})).exit_code, 0);
  const Outcome solve = run_weft({"solve", session.string(), "-q", "--no-previews", "--json"});
  ASSERT_EQ(solve.exit_code, 0) << solve.error;
  const Outcome lone = run_weft({"solve", "--photos", (work_ / "cloth").string(), "-q", "--no-previews",
                                 "--json", "-o", (work_ / "maps").string()});
  ASSERT_EQ(lone.exit_code, 0) << lone.error;
  EXPECT_EQ(solve.json()["pixels"], lone.json()["pixels"]) << "the ball is no cloth";
}

TEST_F(LightsByBall, RawsShowABallToo) {
  simulator::Scene scene;
  scene.camera.width = 640;
  scene.camera.height = 480;
  scene.camera.mm_per_pixel = 0.25;
  scene.camera.distance_mm = kDistance_mm;
  simulator::BallSettings& ball = scene.balls.emplace_back();
  ball.centre_mm = {20, -12, 33};
  ball.radius_mm = 28;
  ball.highlight_deg = 2;
  const auto written = simulator::simulate_session(scene, work_ / "cloth.weft",
                                                   {.tiles = {}, .stop = {}, .progress = {}, .truth = false});
  ASSERT_TRUE(written) << written.error().message();
  fs::create_directories(work_ / "cloth");
  const Result<Session> session = read_session(work_ / "cloth.weft");
  ASSERT_TRUE(session) << session.error().message();
  for (const Shot& shot : session->shots) {
    if (shot.role == ShotRole::kLit)
      fs::copy(work_ / "cloth.weft" / shot.file, work_ / "cloth" / fs::path(shot.file).filename());
  }
  const Outcome told = run_weft(lights({"--json", "--ball"}));
  ASSERT_EQ(told.exit_code, 0) << told.error;
  expect_true(told.json(), scene);
  const Json circle = told.json()["balls"][0];
  EXPECT_NEAR(circle["radius"].get<double>(), 28 / 0.25 * kDistance_mm / (kDistance_mm - 33), 1);
}

TEST_F(LightsByBall, ABallPhotographedFirstGoesByName) {
  const simulator::Scene scene = photograph(work_ / "ball", true);
  photograph(work_ / "cloth", false);
  const Outcome told = run_weft(lights({"--json", "--ball-folder", (work_ / "ball").string(), "--ball",
                                        "204,143,57", "-o", (work_ / "lights.lp").string()}));
  ASSERT_EQ(told.exit_code, 0) << told.error;
  const Json document = told.json();
  expect_true(document, scene);
  EXPECT_FALSE(document["balls"][0]["as_told"]);
  EXPECT_FALSE(fs::exists(work_ / "cloth" / "mask.png")) << "no ball lies on the cloth";
  EXPECT_THAT(bytes_of(work_ / "lights.lp"), testing::HasSubstr("cloth/shot02.exr "));
}

TEST_F(LightsByBall, TwoOfAKnownSizePutTheirLampsIntoTheLightFile) {
  constexpr double kRadius_mm = 34, kTable_mm = 5;
  simulator::Scene scene = photograph(work_ / "one", false);
  scene.camera.width = 640;
  scene.effects.near_light = true;
  for (const Vec3& centre :
       {Vec3{-110, -14, kTable_mm + kRadius_mm}, Vec3{109, 16, kTable_mm + kRadius_mm}}) {
    simulator::BallSettings& ball = scene.balls.emplace_back();
    ball.centre_mm = centre;
    ball.radius_mm = kRadius_mm;
    ball.highlight_deg = 3;
  }
  write_photographs(scene, work_ / "cloth", SampleType::kFloat);
  const std::string fov = fmt::format("{}", degrees(2 * std::atan(640 * kPixel_mm / 2 / kDistance_mm)));
  const Outcome told =
      run_weft({"lights", (work_ / "cloth").string(), "--ball", "--ball-mm", "68", "--fov", fov});
  ASSERT_EQ(told.exit_code, 0) << told.error;
  EXPECT_THAT(told.output, testing::HasSubstr("--mm-per-pixel"));
  const Json lights =
      run_weft({"lights", (work_ / "cloth" / "lights.lp").string(), "--json"}).json()["lights"];
  const auto leds = simulator::rig_of(scene)->leds.leds;
  ASSERT_EQ(lights.size(), leds.size());
  for (std::size_t k = 0; k < leds.size(); ++k) {
    ASSERT_TRUE(lights[k].contains("position")) << lights[k];
    const Json& p = lights[k]["position"];
    const Vec3 truth = leds[k].position_mm - Vec3{0, 0, kTable_mm};
    EXPECT_LT(length(Vec3{p[0], p[1], p[2]} - truth), 0.03 * length(truth)) << k;
  }
  const Outcome solve = run_weft({"solve", "--photos", (work_ / "cloth").string(), "-o",
                                  (work_ / "maps").string(), "--mm-per-pixel", "0.5", "--no-previews"});
  ASSERT_EQ(solve.exit_code, 0) << solve.error;
  EXPECT_THAT(solve.output, testing::HasSubstr("near lights, in mm"));
}

TEST_F(LightsByBall, WhatCannotBeToldIsNamed) {
  photograph(work_ / "cloth", false);
  expect_refusal(work_, lights({"--ball"}), 65, {"no ball is seen", "--ball X,Y,R"});
  expect_refusal(work_, lights({"--ball", "12,x,3"}), 64, {"--ball", "12,x,3", "centre and radius"});
  expect_refusal(work_, lights({"--ball-folder", (work_ / "none").string()}), 66, {"cannot read", "none"});
}

}  // namespace
}  // namespace weft::test
