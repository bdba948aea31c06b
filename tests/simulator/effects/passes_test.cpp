// SPDX-License-Identifier: Apache-2.0
#include "simulator/build_passes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <set>

#include "simulator/geometry/scene_surface.h"
#include "simulator/light/incidence.h"
#include "simulator/simulate.h"
#include "tests/simulator/output.h"

namespace weft::simulator {
namespace {

using testing::ElementsAre;

constexpr Rect kPatch = {100, 60, 140, 90};

std::vector<std::string> names_of(const Scene& scene, Output output) {
  const Result<PassList> list = build_passes(scene, *rig_of(scene), output);
  EXPECT_TRUE(list) << list.error().message();
  std::vector<std::string> names;
  for (const Pass& pass : list->passes) names.push_back(pass.name);
  return names;
}

/// Mean and variance of one plane.
struct Statistics {
  double mean = 0;
  double variance = 0;
};
Statistics statistics_of(const Image<double>& image, int plane) {
  double sum = 0, squares = 0;
  const auto n = static_cast<double>(image.size().pixels());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      sum += image(x, y, plane);
      squares += image(x, y, plane) * image(x, y, plane);
    }
  }
  return {sum / n, squares / n - sum / n * sum / n};
}

TEST(Passes, AreOnlyThoseThatTheSceneCallsFor) {
  Scene scene;
  EXPECT_THAT(names_of(scene, Output::kCounts),
              ElementsAre("camera", "geometry", "albedo", "distant light", "lambert", "mosaic", "converter"));
  scene = near_lit(GeometryKind::kSatin);
  scene.effects.noise = scene.effects.relief = true;
  EXPECT_THAT(names_of(scene, Output::kCounts),
              ElementsAre("camera", "geometry", "dye", "relief", "near light", "lambert", "mosaic", "noise",
                          "converter"));
  EXPECT_THAT(names_of(scene, Output::kRgb),
              ElementsAre("camera", "geometry", "dye", "relief", "near light", "lambert", "rgb", "noise"));
  EXPECT_THAT(names_of(scene, Output::kSurface), ElementsAre("camera", "geometry", "dye", "relief"));
}

TEST(Passes, OfEveryEffectNameIt) {
  Scene scene = near_lit(GeometryKind::kPlain);
  scene.material.dye = flat_spectrum(0.4);
  scene.material.reflectance = Ggx{};
  scene.spectra.filters.fill(flat_spectrum(1));
  for (const EffectKey& effect : effect_keys()) scene.effects.*effect.on = true;
  const Result<PassList> list = build_passes(scene, *rig_of(scene), Output::kCounts);
  ASSERT_TRUE(list) << list.error().message();
  std::set<std::string> named;
  for (const Pass& pass : list->passes) named.insert(pass.effect);
  for (const EffectKey& effect : effect_keys()) {
    const bool has_no_pass_of_its_own =
        std::string(effect.name) == "near_light" ||  // finite_led's stands for it
        std::string(effect.name) == "spectral";      // another set of albedos
    EXPECT_EQ(named.count(effect.name) == 0, has_no_pass_of_its_own) << effect.name;
  }
}

TEST(Passes, AreCountedByTileAndShot) {
  const Scene scene = near_lit(GeometryKind::kPlain);
  PassRunner runner(*build_passes(scene, *rig_of(scene), Output::kCounts), {64, 8, 2});
  const std::vector<int> leds = {3, 0, 7};
  std::vector<std::atomic<int>> shots(11);
  ASSERT_TRUE(runner.run(
      kPatch, leds, {}, [](const PassTile&) {},
      [&](const PassTile& tile) { shots[static_cast<std::size_t>(tile.led)]++; }));
  EXPECT_EQ(shots[3], 4);
  EXPECT_EQ(shots[0], 4);
  EXPECT_EQ(shots[1], 0);
  const std::vector<PassCost> costs = runner.costs();
  EXPECT_EQ(costs.front().pixels, kPatch.pixels()) << "the surface once";
  EXPECT_EQ(costs.back().pixels, 3 * kPatch.pixels()) << "the converter once a shot";
  for (const PassCost& cost : costs) EXPECT_GT(cost.seconds, 0) << cost.name;
}

TEST(Rendering, OfAFlatClothIsTheFormulaAtEveryPixel) {
  Scene scene = near_lit(GeometryKind::kFlat);
  scene.material.albedo = {0.2, 0.3, 0.4};
  scene.lights.mu = 1.7;
  const Rendering r = render(scene, kPatch);
  const SceneRig rig = *rig_of(scene);
  ASSERT_EQ(r.readings.planes(), 30);
  for (int y = 0; y < kPatch.height(); ++y) {
    for (int x = 0; x < kPatch.width(); ++x) {
      const double x_mm = (kPatch.x0 + x - 1231.5) * 0.08, y_mm = (815.5 - kPatch.y0 - y) * 0.08;
      for (std::size_t k = 0; k < 10; ++k) {
        const NearLight& led = rig.leds.leds[k];
        const Vec3 to_led = led.position_mm - Vec3{x_mm, y_mm, 0};
        const double d = length(to_led);
        const double lobe = -dot(to_led, led.aim) / d;
        for (std::size_t c = 0; c < 3; ++c) {
          const double expected =
              scene.material.albedo[c] * led.flux_rgb[c] * std::pow(lobe, 1.7) * to_led.z / (d * d * d);
          const double seen = r.readings(x, y, static_cast<int>(3 * k + c));
          ASSERT_NEAR(seen / expected, 1, 1e-12) << x << ", " << y << ", LED " << k + 1;
        }
      }
    }
  }
}

TEST(Rendering, AtTheTablesCentreIsAlbedoTimesFluxTimesCosineOverDistanceSquared) {
  Scene scene = near_lit(GeometryKind::kFlat);
  scene.material.albedo = {0.2, 0.2, 0.2};
  scene.camera.width = scene.camera.height = 2;
  scene.camera.mm_per_pixel = 1e-4;
  const Rendering r = render(scene, {0, 0, 2, 2});
  EXPECT_NEAR(r.readings(0, 0, 1) / (0.2 * 2e7 * std::cos(radians(35)) / 360000), 1, 1e-6);
  EXPECT_NEAR(r.readings(0, 0, 3 * 9) / (0.2 * 1e7 * std::cos(radians(62)) / 360000), 1, 1e-6);
}

TEST(Rendering, OfDistantLightIsTheSameEverywhere) {
  Scene scene;
  const Rendering r = render(scene, {0, 0, 200, 4});
  for (int plane = 0; plane < 30; ++plane) EXPECT_EQ(r.readings(0, 0, plane), r.readings(199, 3, plane));
  scene.effects.near_light = true;
  const Rendering near = render(scene, {0, 0, 200, 4});
  EXPECT_GT(std::abs(near.readings(0, 0, 0) / near.readings(199, 3, 0) - 1), 0.01);
}

TEST(Rendering, IsDarkOnSlopesThatFaceAway) {
  Scene scene = near_lit(GeometryKind::kTilted);
  scene.geometry.tilt_deg = 70;
  const Rendering r = render(scene, {1200, 800, 1210, 810});
  // LED 1 stands towards x at 35 degrees, LED 3 opposite of it.
  EXPECT_GT(r.readings(5, 5, 0), 0);
  EXPECT_EQ(r.readings(5, 5, 3 * 2), 0);
  EXPECT_NEAR(r.normal(5, 5, 0), std::sin(radians(70)), 1e-15);
}

TEST(Rendering, WithReliefBringsHighPointsNearerToTheLeds) {
  Scene scene = near_lit(GeometryKind::kTilted);
  const Rect left_edge = {0, 800, 8, 808};
  const Rendering plane = render(scene, left_edge);
  scene.effects.relief = true;
  const Rendering relief = render(scene, left_edge);
  const double height_mm = relief.height_mm(0, 0);
  EXPECT_NEAR(height_mm, 1231.5 * 0.08 * std::tan(radians(20)), 1e-9);
  const NearLight led = rig_of(scene)->leds.leds[0];
  const Vec3 point = point_of_pixel(scene, 0, 800);
  const Vec3 n = {relief.normal(0, 0, 0), relief.normal(0, 0, 1), relief.normal(0, 0, 2)};
  const double expected =
      shading(incidence(led, point + Vec3{0, 0, height_mm}), n) / shading(incidence(led, point), n);
  EXPECT_NEAR(relief.readings(0, 0, 1) / plane.readings(0, 0, 1), expected, 1e-12);
}

TEST(Rendering, GivesWarpAndWeftTheirColours) {
  Scene scene = near_lit(GeometryKind::kPlain);
  scene.material.warp_albedo = Rgb{0.1, 0.2, 0.3};
  scene.material.weft_albedo = Rgb{0.7, 0.6, 0.5};
  const Rendering r = render(scene, kPatch);
  int warp = 0;
  for (int y = 0; y < kPatch.height(); ++y) {
    for (int x = 0; x < kPatch.width(); ++x) {
      const Rgb albedo = {r.albedo(x, y, 0), r.albedo(x, y, 1), r.albedo(x, y, 2)};
      ASSERT_TRUE(albedo == *scene.material.warp_albedo || albedo == *scene.material.weft_albedo);
      warp += albedo == *scene.material.warp_albedo;
    }
  }
  EXPECT_NEAR(static_cast<double>(warp) / static_cast<double>(kPatch.pixels()), 0.5, 0.05);
}

TEST(Rendering, StripesBothSetsOfYarns) {
  Scene scene = near_lit(GeometryKind::kPlain);
  scene.geometry.warp_pitch_mm = scene.geometry.weft_pitch_mm = 1;
  scene.camera.mm_per_pixel = 0.5;  // a pixel every half yarn: (x - 1231.5) / 2
  scene.material.warp_albedo = Rgb{0.1, 0.1, 0.1};
  scene.material.weft_albedo = Rgb{0.7, 0.7, 0.7};
  scene.material.stripe_yarns = 4;
  const Rect around_centre = {1200, 790, 1264, 854};
  const Rendering r = render(scene, around_centre);
  const Weave weave(scene.geometry);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const Vec3 p = point_of_pixel(scene, around_centre.x0 + x, around_centre.y0 + y);
      const double yarn = static_cast<double>(weave.at(p.x, p.y).yarn.index);
      const bool second = std::fmod(std::floor(yarn / 4) + 1000, 2) == 1;
      ASSERT_EQ(r.albedo(x, y, 0), second ? 0.7 : 0.1) << "yarn " << yarn;
    }
  }
}

TEST(Rendering, VariesTheBrightnessOfYarnsWithinItsBound) {
  Scene scene = near_lit(GeometryKind::kPlain);
  scene.material.yarn_variation = 0.1;
  const Rendering r = render(scene, {0, 0, 1000, 100});
  double least = 1, most = 0;
  for (int x = 0; x < 1000; ++x) {
    least = std::min(least, r.albedo(x, 50, 0));
    most = std::max(most, r.albedo(x, 50, 0));
    ASSERT_NEAR(r.albedo(x, 50, 0) / r.albedo(x, 50, 2), 1, 1e-12) << "brightness, not hue";
  }
  EXPECT_GE(least, 0.45);
  EXPECT_LE(most, 0.55);
  EXPECT_GT(most - least, 0.08) << "of " << 160 << " yarns some are near the bounds";
}

TEST(Rendering, HasPhotonAndReadNoiseOfTheRightSize) {
  Scene scene;  // distant light on a flat cloth: every pixel has the same mean
  scene.effects.noise = true;
  scene.material.albedo = {0.02, 0.2, 0.9};
  const Rect area = {0, 0, 200, 150};
  const Rendering noisy_picture = render(scene, area);
  scene.effects.noise = false;
  const Rendering clean = render(scene, area);
  const double exposure = rig_of(scene)->exposure(100);
  for (int plane = 0; plane < 30; ++plane) {
    const double electrons = clean.readings(0, 0, plane) * exposure * 40000;
    const double variance = electrons + 9;
    const Statistics s = statistics_of(noisy_picture.readings, plane);
    const double scale = exposure * 40000;
    EXPECT_LT(std::abs(s.mean * scale - electrons) / std::sqrt(variance / 30000), 4.5) << "plane " << plane;
    EXPECT_LT(std::abs(s.variance * scale * scale / variance - 1) / std::sqrt(2.0 / 30000), 4.5)
        << "plane " << plane;
  }
}

TEST(Rendering, DoesNotDependOnTilesThreadsOrTheAreaAskedFor) {
  Scene scene = near_lit(GeometryKind::kTwill);
  scene.effects.noise = true;
  scene.material.yarn_variation = 0.1;
  const Rendering whole = render(scene, {64, 40, 192, 100}, {512, 32, 1});
  for (const TileOptions& tiles : {TileOptions{64, 1, 2}, TileOptions{128, 7, 7}}) {
    const Rendering part = render(scene, kPatch, tiles);
    for (int plane = 0; plane < 30; ++plane) {
      for (int y = 0; y < kPatch.height(); ++y) {
        for (int x = 0; x < kPatch.width(); ++x) {
          ASSERT_EQ(part.readings(x, y, plane), whole.readings(x + 36, y + 20, plane));
        }
      }
    }
    ASSERT_EQ(part.height_mm(3, 4), whole.height_mm(39, 24));
  }
}

TEST(Rendering, ChangesItsNoiseWithSeedAndShotOnly) {
  Scene scene;
  scene.effects.noise = true;
  scene.lights.rings = {{2, 0, 0, 600}};  // twice the same light
  const Rect area = {0, 0, 64, 4};
  const Rendering a = render(scene, area), again = render(scene, area);
  scene.seed = 2;
  const Rendering b = render(scene, area);
  int same_shot = 0, same_seed = 0;
  for (int x = 0; x < 64; ++x) {
    EXPECT_EQ(a.readings(x, 1, 0), again.readings(x, 1, 0));
    same_shot += a.readings(x, 1, 0) == a.readings(x, 1, 3);
    same_seed += a.readings(x, 1, 0) == b.readings(x, 1, 0);
  }
  EXPECT_LT(same_shot, 5);
  EXPECT_LT(same_seed, 5);
}

TEST(Rendering, RefusesAnAreaWithoutPixelsOrFarAway) {
  for (const Rect area :
       {Rect{0, 0, 0, 5}, Rect{5, 0, 4, 1}, Rect{0, 0, 2000000, 1}, Rect{-2000000000, 0, 2000000000, 1}}) {
    const Result<Rendering> none = render_readings(Scene(), area);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().kind, ErrorKind::kUsage);
  }
}

}  // namespace
}  // namespace weft::simulator
