// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "simulator/simulate.h"
#include "tests/simulator/output.h"

// Films before LEDs and lens: what passes them, and the sessions that are made through them.

namespace weft::simulator {
namespace {

namespace fs = std::filesystem;

Scene satin_scene() {
  Scene scene;
  scene.camera.width = 48;
  scene.camera.height = 32;
  scene.geometry.kind = GeometryKind::kPlain;
  scene.effects.near_light = scene.effects.relief = scene.effects.interreflection = true;
  scene.transport.bounce_rays = 8;
  scene.effects.stray = scene.effects.reflectance = true;
  // Nothing of the scattered part depends on the lobe above it.
  scene.material.reflectance = Ggx{.alpha = 0.4, .beneath = Beneath::kLambert};
  return scene;
}

Image<double> part_of(const Scene& scene) {
  Result<Rendering> rendered = render_readings(scene, {8, 8, 24, 16});
  EXPECT_TRUE(rendered) << rendered.error().message();
  return rendered ? std::move(rendered->readings) : Image<double>();
}

fs::path films_folder() {
  const fs::path folder = fs::path(testing::TempDir()) / "weft_films" /
                          testing::UnitTest::GetInstance()->current_test_info()->name();
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

Session session_of(const Scene& scene, const fs::path& folder) {
  const Result<SimulationReport> report = simulate_session(scene, folder, {});
  EXPECT_TRUE(report) << report.error().message();
  const Result<Session> session = read_session(folder);
  EXPECT_TRUE(session) << session.error().message();
  return session ? *session : Session();
}

// A quarter of scattered light, between yarns and by way of the rig too, passes in either state; of mirrored
// light half passes parallel films and a hundredth of that crossed ones.
TEST(Films, LetScatteredAndMirroredLightThroughByTheirOwnShares) {
  Scene scene = satin_scene();
  const Image<double> all = part_of(scene);
  scene.material.reflectance = Lambert{};
  const Image<double> scattered = part_of(scene);
  scene = satin_scene();
  scene.films = {.states = FilmStates::kParallel, .transmission = 0.9};
  const Image<double> parallel = part_of(scene);
  scene.films.states = FilmStates::kCrossed;
  const Image<double> crossed = part_of(scene);
  double most_mirrored = 0;
  for (int p = 0; p < all.planes(); ++p) {
    for (int y = 0; y < all.height(); ++y) {
      for (int x = 0; x < all.width(); ++x) {
        const double d = scattered(x, y, p), s = all(x, y, p) - d, through_both = 0.9 * 0.9;
        most_mirrored = std::max(most_mirrored, s / d);
        EXPECT_NEAR(parallel(x, y, p), through_both * (d / 4 + s / 2), 1e-9 * d);
        EXPECT_NEAR(crossed(x, y, p), through_both * (d / 4 + 0.01 * s / 2), 1e-9 * d);
      }
    }
  }
  EXPECT_GT(most_mirrored, 0.05) << "the cloth has gloss";
}

TEST(Films, OfASessionAreCrossedFirstAndThenParallel) {
  const fs::path folder = films_folder();
  Scene scene = satin_scene();
  scene.effects.noise = true;
  scene.films = {.states = FilmStates::kBoth, .leak = 0.02};
  const Session both = session_of(scene, folder / "both.weft");
  ASSERT_EQ(both.shots.size(), 21U);
  EXPECT_EQ(both.lit(Polariser::kCrossed).size(), 10U);
  ASSERT_EQ(both.lit(Polariser::kParallel).size(), 10U);
  EXPECT_EQ(both.lit().front()->file, "raw/00_led01_crossed.dng");
  EXPECT_EQ(both.lit(Polariser::kParallel).front()->file, "raw/10_led01_parallel.dng");
  EXPECT_EQ(both.films.leak, 0.02);
  EXPECT_EQ(both.films.scattered, 1) << "the exact calibration is made through the films";
  EXPECT_TRUE(fs::exists(folder / "both.weft" / "truth" / "indirect_led10.exr"));

  scene.films.states = FilmStates::kCrossed;
  const Session crossed = session_of(scene, folder / "crossed.weft");
  ASSERT_EQ(crossed.shots.size(), 11U);
  for (std::size_t k = 0; k < 10; ++k)
    EXPECT_EQ(crossed.lit()[k]->sha256, both.lit()[k]->sha256) << "LED " << k + 1;
  EXPECT_EQ(crossed.calibration_id, both.calibration_id);
}

TEST(Films, TakeFourTimesTheExposure) {
  const fs::path folder = films_folder();
  Scene scene = satin_scene();
  const Session plain = session_of(scene, folder / "plain.weft");
  scene.films.states = FilmStates::kCrossed;
  const Session filmed = session_of(scene, folder / "filmed.weft");
  EXPECT_NEAR(filmed.lit()[0]->exposure_us, 4 * plain.lit()[0]->exposure_us, 4);
}

// A LED beside the camera is one more ring of a scene.
TEST(Films, AndAnEleventhLedMakeASessionOfElevenPairs) {
  const Result<Scene> scene = parse_scene(R"(
[camera]
width = 32
height = 32
[[lights.ring]]
count = 4
zenith_deg = 35
[[lights.ring]]
count = 6
zenith_deg = 62
azimuth_deg = 15
[[lights.ring]]
count = 1
zenith_deg = 8
azimuth_deg = 120
[films]
states = "both"
leak = 0.005
[effects]
near_light = true
)",
                                          "eleven.toml");
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(*parse_scene(to_toml(*scene), "again"), *scene);
  const Session session = session_of(*scene, films_folder() / "eleven.weft");
  EXPECT_EQ(session.lit(Polariser::kCrossed).size(), 11U);
  EXPECT_EQ(session.lit(Polariser::kParallel).size(), 11U);
  const Result<Calibration> calibration = read_calibration(session.calibration_folder());
  ASSERT_TRUE(calibration) << calibration.error().message();
  const NearLights& lights = std::get<NearLights>(*calibration->lights);
  ASSERT_EQ(lights.leds.size(), 11U);
  EXPECT_NEAR(angle_deg(lights.leds[10].position_mm, {0, 0, 1}), 8, 1e-6);
}

}  // namespace
}  // namespace weft::simulator
