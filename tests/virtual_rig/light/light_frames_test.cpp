// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/light/light_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/image/raw_frame.h"
#include "simulator/simulate.h"
#include "tests/virtual_rig/small_scene.h"

namespace weft::virtual_rig {
namespace {

namespace fs = std::filesystem;
using simulator::Scene;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

LightFrames opened(const Scene& scene, const fs::path& cache, const RenderLightOptions& options = {}) {
  Result<LightFrames> frames = LightFrames::open(scene, cache, options);
  if (!frames) throw std::runtime_error(frames.error().message());
  return std::move(*frames);
}

/// Names in a folder, sorted.
std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

/// Largest difference of a plane from the simulator's own numbers, relative to the brightest.
double error_of(View<const float> plane, const simulator::Rendering& truth, int first_plane) {
  constexpr CfaPattern kCfa;
  double worst = 0, brightest = 0;
  for (int y = 0; y < plane.height(); ++y) {
    for (int x = 0; x < plane.width(); ++x) {
      const double wanted = truth.readings(x, y, first_plane + kCfa.channel_at(x, y));
      worst = std::max(worst, std::abs(static_cast<double>(plane(x, y)) - wanted));
      brightest = std::max(brightest, wanted);
    }
  }
  return worst / brightest;
}

TEST(LightFrames, HoldWhatEachLedPutsOnEachPhotosite) {
  Scene scene = small_scene();
  scene.camera.iso = 200;
  scene.effects.vignetting = scene.effects.defocus = scene.effects.relief = scene.effects.stray = true;
  const LightFrames frames = opened(scene, fresh_folder());
  scene.effects.noise = false;
  const Result<simulator::Rendering> truth = render_readings(scene, {0, 0, 128, 96});
  ASSERT_TRUE(truth) << truth.error().message();
  ASSERT_EQ(frames.leds(), 3);
  for (int led = 1; led <= 3; ++led) {
    EXPECT_LT(error_of(frames.led(led), *truth, 3 * (led - 1)), 1e-7) << "LED " << led;
  }
}

TEST(LightFrames, HoldTheRoomsLightWhetherTheSceneNamesItOrNot) {
  const fs::path cache = fresh_folder();
  const LightFrames without = opened(small_scene(), cache);
  Scene lit = small_scene();
  lit.effects.ambient = true;
  lit.lights.ambient = 0.25;
  const LightFrames with = opened(lit, cache);
  EXPECT_GT(without.ambient()(60, 40), 0);
  EXPECT_EQ(without.ambient()(60, 40), with.ambient()(60, 40)) << "in units of lights.ambient";
  EXPECT_EQ(without.led(2)(60, 40), with.led(2)(60, 40)) << "no LED's plane holds it";
}

TEST(LightFrames, AreTheSameForAnyNumberOfThreads) {
  Scene scene = small_scene(600);
  scene.effects.relief = scene.effects.cast_shadows = true;
  const fs::path folder = fresh_folder();
  const LightFrames one = opened(scene, folder / "one", {.tiles = {.threads = 1}});
  const LightFrames four =
      opened(scene, folder / "four", {.tiles = {.width = 64, .height = 7, .threads = 4}});
  for (int led = 1; led <= one.leds(); ++led) {
    for (int y = 0; y < 96; ++y) {
      ASSERT_TRUE(std::equal(one.led(led).row(y), one.led(led).row(y) + 600, four.led(led).row(y)))
          << "LED " << led << ", row " << y;
    }
  }
}

TEST(LightFrames, AreRenderedOnceByThreadsThatComeTogether) {
  const fs::path cache = fresh_folder();
  std::atomic<int> renders = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 6; ++t) {
    threads.emplace_back([&] {
      bool has_rendered = false;
      RenderLightOptions options;
      options.tiles.threads = 1;
      options.progress = [&](double) { has_rendered = true; };
      const Result<LightFrames> frames = LightFrames::open(small_scene(), cache, options);
      EXPECT_TRUE(frames) << frames.error().message();
      renders += has_rendered ? 1 : 0;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(renders, 1);
}

using Program = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

Program open_light(const fs::path& cache, const std::string& arguments) {
  return {::popen(("exec " WEFT_OPEN_LIGHT " '" + cache.string() + "' " + arguments).c_str(), "re"),
          &::pclose};
}

std::string said_by(const Program& program) {
  char line[64] = "nothing";
  static_cast<void>(std::fgets(line, sizeof line, program.get()));
  return line;
}

TEST(LightFrames, AreRenderedOnceByProgramsThatComeTogether) {
  const fs::path cache = fresh_folder();
  std::vector<Program> programs;
  for (int p = 0; p < 5; ++p) programs.push_back(open_light(cache, "640"));
  std::vector<std::string> said;
  for (const Program& program : programs) said.push_back(said_by(program));
  std::sort(said.begin(), said.end());
  EXPECT_THAT(said, ElementsAre("found\n", "found\n", "found\n", "found\n", "rendered\n"));
}

TEST(LightFrames, AreRenderedByTheNextProgramWhereOneWasKilledHalfWay) {
  const fs::path cache = fresh_folder();
  EXPECT_EQ(said_by(open_light(cache, "640 kill")), "nothing");
  EXPECT_THAT(names_in(cache), testing::Contains(testing::EndsWith(".partial"))) << "it was killed too late";
  EXPECT_EQ(said_by(open_light(cache, "640")), "rendered\n");
  EXPECT_EQ(said_by(open_light(cache, "640")), "found\n");
  EXPECT_THAT(names_in(cache), SizeIs(2)) << "the planes and their lock";
}

TEST(LightFrames, AreRenderedAgainWhereTheirFileIsTooShort) {
  const fs::path folder = fresh_folder(), cache = folder / "cache", other = folder / "other";
  const LightFrames whole = opened(small_scene(), cache);
  const float wanted = whole.led(1)(100, 90);
  fs::copy(cache, other, fs::copy_options::recursive);
  fs::resize_file(other / whole.folder().filename() / "light.f32", 1000);
  EXPECT_EQ(opened(small_scene(), other).led(1)(100, 90), wanted);
}

TEST(LightFrames, ArePutAsideAndRemovedWhenRenderingIsStopped) {
  const fs::path cache = fresh_folder();
  std::stop_source stop;
  stop.request_stop();
  const Result<LightFrames> frames = LightFrames::open(small_scene(), cache, {.stop = stop.get_token()});
  ASSERT_FALSE(frames);
  EXPECT_EQ(frames.error().kind, ErrorKind::kInterrupted);
  EXPECT_THAT(names_in(cache), SizeIs(1)) << "the lock";
}

TEST(LightFrames, OfScenesThatDifferAreKeptApart) {
  const fs::path cache = fresh_folder();
  Scene other = small_scene();
  other.seed = 2;
  EXPECT_NE(opened(small_scene(), cache).folder(), opened(other, cache).folder());
  auto heights = std::make_shared<Image<float>>(Size{8, 8});
  (*heights)(3, 3) = 1;
  Scene map = small_scene();
  map.geometry.kind = simulator::GeometryKind::kHeightMap;
  map.geometry.heights_mm = heights;
  const fs::path before = opened(map, cache).folder();
  auto changed = std::make_shared<Image<float>>(Size{8, 8});
  (*changed)(3, 3) = 2;
  map.geometry.heights_mm = changed;
  EXPECT_NE(opened(map, cache).folder(), before) << "the same scene file with another picture";
}

TEST(LightFrames, SayWhatOfTheSceneTheyLeaveOut) {
  Scene scene = small_scene();
  const fs::path cache = fresh_folder();
  EXPECT_THAT(opened(scene, cache).left_out(), SizeIs(0));
  scene.effects.movement = scene.effects.led_drift = true;
  scene.damage.push_back({.kind = simulator::DamageKind::kBlack});
  EXPECT_THAT(opened(scene, cache).left_out(),
              ElementsAre(HasSubstr("movement"), HasSubstr("led_drift"), HasSubstr("damage")));
}

TEST(LightFrames, SayThatTheirCacheCannotBeMade) {
  const fs::path folder = fresh_folder();
  std::ofstream(folder / "file") << "no folder";
  const Result<LightFrames> frames = LightFrames::open(small_scene(), folder / "file");
  ASSERT_FALSE(frames);
  EXPECT_EQ(frames.error().kind, ErrorKind::kCannotCreate);
  EXPECT_THAT(frames.error().remedy, HasSubstr("XDG_CACHE_HOME"));
}

}  // namespace
}  // namespace weft::virtual_rig
