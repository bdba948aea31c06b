// SPDX-License-Identifier: Apache-2.0
#include "simulator/simulate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "core/base/files.h"
#include "core/image_io/image_io.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "simulator/camera/sensor.h"
#include "tests/simulator/output.h"

namespace weft::simulator {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

/// An empty folder of this test's own.
fs::path fresh_folder() {
  const fs::path folder = fs::path(testing::TempDir()) / "weft_simulate" /
                          testing::UnitTest::GetInstance()->current_test_info()->name();
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

/// A twill of 128 x 96 pixels.
Scene small_scene() {
  Scene scene;
  scene.camera.width = 128;
  scene.camera.height = 96;
  scene.geometry.kind = GeometryKind::kTwill;
  scene.geometry.cloth_height_mm = 2;
  scene.material.warp_albedo = Rgb{0.1, 0.2, 0.3};
  scene.effects.near_light = true;
  return scene;
}

SimulationReport simulated(const Scene& scene, const fs::path& folder, const SimulateOptions& options = {}) {
  const Result<SimulationReport> report = simulate_session(scene, folder, options);
  EXPECT_TRUE(report) << report.error().message();
  return report ? *report : SimulationReport();
}

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

/// Every file below a folder with its bytes.
std::map<std::string, std::string> contents_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files[fs::relative(entry.path(), folder).string()] = bytes_of(entry.path());
  }
  return files;
}

std::vector<std::uint16_t> counts_of(const fs::path& file) {
  const RawFrame frame = decoded(file);
  std::vector<std::uint16_t> counts;
  for (int y = 0; y < frame.counts.height(); ++y) {
    const std::uint16_t* row = frame.counts.plane().row(y);
    counts.insert(counts.end(), row, row + frame.counts.width());
  }
  return counts;
}

TEST(Simulate, WritesASessionThatReadsBack) {
  const fs::path folder = fresh_folder() / "a.weft";
  const Scene scene = small_scene();
  const SimulationReport report = simulated(scene, folder);
  EXPECT_EQ(report.frames, 11);

  const Result<Session> session = read_session(folder);
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->state, "complete");
  EXPECT_EQ(session->fabric, scene.fabric);
  EXPECT_EQ(session->cloth_height_mm, 2);
  ASSERT_EQ(session->shots.size(), 11U);
  ASSERT_NE(session->dark(), nullptr);
  EXPECT_EQ(session->dark()->file, "raw/10_led00.dng");
  EXPECT_EQ(session->lit()[2]->file, "raw/02_led03.dng");
  for (const Shot& shot : session->shots) {
    EXPECT_EQ(shot.exposure_us, report.exposure_us);
    EXPECT_EQ(shot.sha256, *sha256_of_file(session->path_of(shot))) << shot.file;
  }

  const Result<Calibration> calibration = read_calibration(session->calibration_folder());
  ASSERT_TRUE(calibration) << calibration.error().message();
  EXPECT_EQ(calibration->id, session->calibration_id);
  EXPECT_EQ(calibration->camera->size, (Size{128, 96}));
  EXPECT_EQ(std::get<NearLights>(*calibration->lights).leds.size(), 10U);

  const Result<Scene> copy = read_scene(folder / "truth" / "scene.toml");
  ASSERT_TRUE(copy) << copy.error().message();
  EXPECT_EQ(*copy, scene);
}

TEST(Simulate, CountsWhatTheReadingsSay) {
  const fs::path folder = fresh_folder() / "a.weft";
  const Scene scene = small_scene();
  const SimulationReport report = simulated(scene, folder);
  const Result<Rendering> truth = render_readings(scene, {0, 0, 128, 96});
  ASSERT_TRUE(truth);
  for (int led = 1; led <= 10; ++led) {
    const std::string file =
        "raw/0" + std::to_string(led - 1) + "_led" + (led < 10 ? "0" : "") + std::to_string(led) + ".dng";
    const std::vector<std::uint16_t> counts = counts_of(folder / file);
    for (int y = 0; y < 96; ++y) {
      for (int x = 0; x < 128; ++x) {
        const int channel = (x & 1) + (y & 1);  // red, green / green, blue
        const double reading = truth->readings(x, y, 3 * (led - 1) + channel);
        const double expected = 600 + 14920 * reading * report.exposure_us * 1e-6;
        ASSERT_NEAR(counts[static_cast<std::size_t>(128 * y + x)], expected, 0.5 + 1e-9)
            << file << " " << x << ", " << y;
      }
    }
  }
  for (const std::uint16_t count : counts_of(folder / "raw/10_led00.dng")) ASSERT_EQ(count, 600);
}

TEST(Simulate, WritesFramesThatSayWhatTheyAre) {
  for (const Body body : {Body::kOffset, Body::kD5100}) {
    const fs::path folder = fresh_folder() / "a.weft";
    Scene scene = small_scene();
    scene.lights.rings = {{1, 50, 0, 600}};
    scene.camera.body = body;
    scene.camera.iso = 200;
    scene.camera.f_number = 5.6;
    const SimulationReport report = simulated(scene, folder);
    const RawFrame frame = decoded(folder / "raw/00_led01.dng");
    const Sensor sensor = sensor_of(scene.camera);
    EXPECT_EQ(frame.counts.size(), (Size{128, 96}));
    EXPECT_EQ(frame.cfa, CfaPattern());
    EXPECT_EQ(frame.white, static_cast<float>(sensor.white));
    for (const auto& row : frame.black) {
      for (const float black : row) EXPECT_EQ(black, static_cast<float>(sensor.black));
    }
    EXPECT_THAT(frame.shot.model, HasSubstr(body == Body::kD5100 ? "D5100" : "virtual camera"));
    EXPECT_NEAR(frame.shot.exposure_us / report.exposure_us, 1, 1e-6);
    EXPECT_EQ(frame.shot.iso, 200);
    EXPECT_NEAR(frame.shot.f_number, 5.6, 1e-6);
  }
}

TEST(Simulate, WritesTheTruthItRendered) {
  const fs::path folder = fresh_folder() / "a.weft";
  Scene scene = small_scene();
  scene.camera.height = 300;  // more than two bands of rows
  simulated(scene, folder);
  const Result<Rendering> truth = render_readings(scene, {0, 0, 128, 300});
  ASSERT_TRUE(truth);
  const auto compare = [&](const char* file, const std::vector<std::string>& channels,
                           const Image<double>& expected) {
    const Result<LoadedImage> image = read_image(folder / "truth" / file);
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->info.channels, channels);
    EXPECT_EQ(image->info.type, SampleType::kFloat);
    ASSERT_EQ(image->info.size, (Size{128, 300}));
    for (int p = 0; p < expected.planes(); ++p) {
      for (int y = 0; y < 300; ++y) {
        for (int x = 0; x < 128; ++x) {
          ASSERT_EQ(image->planes(x, y, p), static_cast<float>(expected(x, y, p)))
              << file << " " << x << ", " << y;
        }
      }
    }
  };
  compare("normal.exr", {"X", "Y", "Z"}, truth->normal);
  compare("albedo.exr", {"R", "G", "B"}, truth->albedo);
  compare("height.exr", {"Y"}, truth->height_mm);
}

TEST(Simulate, GivesTheSameBytesForAnyThreadsAndTiles) {
  const fs::path folder = fresh_folder();
  Scene scene = small_scene();
  scene.lights.rings = {{3, 50, 0, 600}};
  scene.effects.noise = true;
  scene.material.yarn_variation = 0.1;
  SimulateOptions options;
  options.tiles = {512, 32, 1};
  simulated(scene, folder / "one.weft", options);
  const auto one = contents_of(folder / "one.weft");
  EXPECT_EQ(one.size(), 4U + 1 + 4 + 4) << "frames, session, calibration, truth";
  for (const TileOptions& tiles : {TileOptions{64, 5, 2}, TileOptions{64, 1, 7}}) {
    options.tiles = tiles;
    fs::remove_all(folder / "many.weft");
    simulated(scene, folder / "many.weft", options);
    const auto many = contents_of(folder / "many.weft");
    ASSERT_EQ(many.size(), one.size());
    for (const auto& [name, bytes] : one) EXPECT_TRUE(many.at(name) == bytes) << name;
  }
}

/// A deep weave with everything that can be simulated.
Scene hard_scene() {
  Scene scene = small_scene();
  scene.camera.width = 96;
  scene.camera.height = 64;
  scene.camera.mm_per_pixel = 0.05;
  scene.geometry = family_settings(Family::kDeep);
  scene.lights.rings = {{2, 50, 0, 600}};
  for (const EffectKey& effect : effect_keys()) scene.effects.*effect.on = true;
  scene.effects.spectral = false;
  scene.material.reflectance = Ggx{.alpha = 0.4};
  scene.transport.bounce_rays = 2;
  scene.transport.shadow_rays = 4;
  return scene;
}

TEST(Simulate, GivesTheSameBytesForAnyThreadsAndTilesWithAllEffects) {
  const fs::path folder = fresh_folder();
  SimulateOptions options;
  options.tiles = {512, 256, 1};
  const Scene scene = hard_scene();
  simulated(scene, folder / "one.weft", options);
  const auto one = contents_of(folder / "one.weft");
  EXPECT_EQ(one.size(), 3U + 1 + 4 + 4 + 2 * 2 + 3)
      << "frames, session, calibration, truth, light of two LEDs, openness and lobe";
  options.tiles = {64, 32, 3};
  simulated(scene, folder / "many.weft", options);
  for (const auto& [name, bytes] : contents_of(folder / "many.weft")) {
    EXPECT_TRUE(one.at(name) == bytes) << name;
  }
}

TEST(Simulate, RendersASingleFrameAlone) {
  const fs::path folder = fresh_folder();
  for (const Scene& scene : {small_scene(), hard_scene()}) {
    fs::remove_all(folder / "a.weft");
    simulated(scene, folder / "a.weft");
    const Result<void> alone = simulate_frame(scene, 2, folder / "alone.dng", {});
    ASSERT_TRUE(alone) << alone.error().message();
    EXPECT_TRUE(bytes_of(folder / "alone.dng") == bytes_of(folder / "a.weft/raw/01_led02.dng"));
  }
  const Result<void> none = simulate_frame(small_scene(), 11, folder / "none.dng", {});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::kUsage);
}

TEST(Simulate, ClipsAtWhiteAndNeverAbove) {
  for (const Body body : {Body::kOffset, Body::kD5100}) {
    const fs::path folder = fresh_folder() / "a.weft";
    Scene scene = small_scene();
    scene.lights.rings = {{1, 50, 0, 600}};
    scene.effects.noise = true;
    scene.camera.body = body;
    scene.camera.exposure_us = 100000;
    simulated(scene, folder);
    const int white = body == Body::kOffset ? 15520 : 15846;
    const std::vector<std::uint16_t> counts = counts_of(folder / "raw/00_led01.dng");
    EXPECT_EQ(*std::max_element(counts.begin(), counts.end()), white);
    EXPECT_GT(std::count(counts.begin(), counts.end(), white), 1000);
    const std::vector<std::uint16_t> dark = counts_of(folder / "raw/01_led00.dng");
    const auto at_zero = std::count(dark.begin(), dark.end(), 0);
    if (body == Body::kD5100) {
      EXPECT_GT(at_zero, 128 * 96 / 2) << "the dark is clipped at 0";
    } else {
      EXPECT_EQ(at_zero, 0);
    }
  }
}

TEST(Simulate, ReportsWhatRanAndWhatItCost) {
  Scene scene = small_scene();
  scene.camera.height = 200;  // two bands of rows
  SimulateOptions options;
  std::vector<int> rows;
  options.progress = [&](int done, int of) {
    EXPECT_EQ(of, 400);
    rows.push_back(done);
  };
  const SimulationReport report = simulated(scene, fresh_folder() / "a.weft", options);
  EXPECT_THAT(rows, testing::ElementsAre(128, 200, 328, 400));
  std::map<std::string, std::int64_t> pixels;
  for (const PassCost& cost : report.passes) pixels[cost.name] = cost.pixels;
  EXPECT_EQ(pixels.at("geometry"), 128 * 200) << "once for all frames together";
  EXPECT_EQ(pixels.at("near light"), 11 * 128 * 200);
  EXPECT_EQ(pixels.count("noise"), 0U);
  EXPECT_EQ(report.left_out.size(), effect_keys().size() - 1);
  EXPECT_EQ(report.left_out.back().name, "noise");
  EXPECT_GT(report.render_seconds, 0);
  EXPECT_GT(report.write_seconds, 0);
}

TEST(Simulate, LeavesNothingWhenItIsInterrupted) {
  for (const int after : {0, 96, 192}) {
    const fs::path folder = fresh_folder();
    std::stop_source source;
    SimulateOptions options;
    options.stop = source.get_token();
    options.progress = [&](int done, int) {
      if (done == after) source.request_stop();
    };
    if (after == 0) source.request_stop();
    const Result<SimulationReport> report = simulate_session(small_scene(), folder / "a.weft", options);
    ASSERT_FALSE(report) << after;
    EXPECT_EQ(report.error().kind, ErrorKind::kInterrupted);
    EXPECT_TRUE(fs::is_empty(folder)) << after;
  }
}

TEST(Simulate, NeverTouchesWhatIsThere) {
  const fs::path folder = fresh_folder();
  fs::create_directory(folder / "a.weft");
  const Result<SimulationReport> over = simulate_session(small_scene(), folder / "a.weft", {});
  ASSERT_FALSE(over);
  EXPECT_EQ(over.error().kind, ErrorKind::kCannotCreate);
  EXPECT_TRUE(fs::is_empty(folder / "a.weft"));
}

TEST(Simulate, MakesTheParentsOfItsFolder) {
  const fs::path folder = fresh_folder();
  simulated(small_scene(), folder / "new" / "a.weft");
  EXPECT_TRUE(fs::exists(folder / "new" / "a.weft" / "session.json"));
}

TEST(Simulate, SaysWhereItCannotWrite) {
  const fs::path folder = fresh_folder();
  std::ofstream(folder / "file") << "not a folder";
  const Result<SimulationReport> in_file = simulate_session(small_scene(), folder / "file" / "a.weft", {});
  ASSERT_FALSE(in_file);
  EXPECT_EQ(in_file.error().kind, ErrorKind::kCannotCreate) << in_file.error().message();
  const Result<SimulationReport> no_name = simulate_session(small_scene(), "", {});
  ASSERT_FALSE(no_name);
  EXPECT_EQ(no_name.error().kind, ErrorKind::kUsage) << no_name.error().message();
  EXPECT_THAT(names_in(folder), ElementsAre("file"));
}

TEST(Simulate, TakesAFolderNameWithASlashAtItsEnd) {
  const fs::path folder = fresh_folder();
  simulated(small_scene(), (folder / "a.weft").string() + "/");
  EXPECT_TRUE(fs::exists(folder / "a.weft" / "session.json"));
  EXPECT_THAT(names_in(folder), ElementsAre("a.weft"));
}

TEST(Simulate, TruthHoldsTheLobeAndHowYarnsLie) {
  const fs::path folder = fresh_folder() / "a.weft";
  Scene scene = small_scene();
  scene.effects.reflectance = true;
  scene.material.reflectance = AnisotropicGgx{.alpha = 0.5, .anisotropy = 0.75, .f0 = {0.0625, 0.125, 0.25}};
  simulated(scene, folder);
  const Result<LoadedImage> roughness = read_image(folder / "truth" / "roughness.exr");
  const Result<LoadedImage> specular = read_image(folder / "truth" / "specular.exr");
  const Result<LoadedImage> albedo = read_image(folder / "truth" / "albedo.exr");
  ASSERT_TRUE(roughness && specular && albedo);
  int wefts = 0;
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 128; ++x) {
      ASSERT_NEAR(roughness->channel("roughness")(x, y), 0.5, 1e-3);  // (0.5 * 0.125)^(1/4)
      ASSERT_EQ(roughness->channel("alpha")(x, y), 0.5F);
      ASSERT_EQ(roughness->channel("alpha_along")(x, y), 0.125F);
      ASSERT_EQ(specular->channel("B")(x, y), 0.25F);
      // Warp lies along y, and is dyed dark.
      const bool is_warp = albedo->channel("R")(x, y) < 0.15F;
      wefts += !is_warp;
      ASSERT_NEAR(roughness->channel("yarn_deg")(x, y), is_warp ? 90 : 0, 1e-3) << x << ", " << y;
    }
  }
  EXPECT_GT(wefts, 1000);
  EXPECT_LT(wefts, 11000);
}

TEST(Simulate, TruthOfMattClothHasNoLobe) {
  const fs::path folder = fresh_folder() / "a.weft";
  simulated(small_scene(), folder);
  EXPECT_THAT(names_in(folder / "truth"),
              testing::UnorderedElementsAre("albedo.exr", "height.exr", "normal.exr", "scene.toml"));
}

TEST(Simulate, TruthHoldsTheOpennessThatBouncesLeave) {
  for (const bool is_level : {true, false}) {
    const fs::path folder = fresh_folder() / "a.weft";
    Scene scene = small_scene();
    if (is_level) {
      scene.geometry = {};
      scene.material = {};
    }
    scene.effects.relief = scene.effects.interreflection = true;
    simulated(scene, folder);
    const Result<LoadedImage> openness = read_image(folder / "truth" / "openness.exr");
    ASSERT_TRUE(openness) << is_level;
    double sum = 0;
    for (int y = 0; y < 96; ++y) {
      for (int x = 0; x < 128; ++x) {
        const float open = openness->planes(x, y);
        ASSERT_TRUE(open >= 0 && open <= 1) << open;
        sum += static_cast<double>(open) / (128 * 96);
      }
    }
    if (is_level) {
      EXPECT_NEAR(sum, 1, 1e-9);
    } else {
      EXPECT_TRUE(sum > 0.5 && sum < 0.99) << sum;
    }
  }
}

TEST(Simulate, RefusesASceneMadeInCodeThatBreaksItsRanges) {
  Scene scene = small_scene();
  scene.camera.height = -4;
  const Result<SimulationReport> report = simulate_session(scene, fresh_folder() / "a.weft", {});
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().message(), HasSubstr("camera.height"));
}

}  // namespace
}  // namespace weft::simulator
