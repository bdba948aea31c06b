// SPDX-License-Identifier: Apache-2.0
#include "simulator/effects/bounds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>

#include "simulator/build_passes.h"
#include "simulator/light/incidence.h"

namespace weft::simulator {
namespace {

using testing::HasSubstr;

constexpr double kPercent = 0.01;

std::size_t number_of(const std::string& effect) {
  const auto keys = effect_keys();
  const auto found =
      std::find_if(keys.begin(), keys.end(), [&](const EffectKey& key) { return key.name == effect; });
  EXPECT_NE(found, keys.end()) << effect;
  return static_cast<std::size_t>(found - keys.begin());
}

EffectBound bound_of(const Scene& scene, const std::string& effect) {
  const Result<SceneRig> rig = rig_of(scene);
  EXPECT_TRUE(rig) << rig.error().message();
  return bounds_of(scene, *rig)[number_of(effect)];
}

Scene family(Family kind) {
  Scene scene;
  scene.geometry = family_settings(kind);
  return scene;
}

TEST(Bounds, ASmallLedDropsOutByItselfOnSmoothClothAndStaysOnDeep) {
  const Scene smooth = family(Family::kSmooth);
  std::vector<LeftOutEffect> left_out;
  const EffectSettings on = effects_within(smooth, *rig_of(smooth), 0.01, left_out);
  EXPECT_FALSE(on.finite_led);
  EXPECT_TRUE(on.near_light);
  const auto led = std::find_if(left_out.begin(), left_out.end(),
                                [](const LeftOutEffect& effect) { return effect.name == "finite_led"; });
  ASSERT_NE(led, left_out.end());
  EXPECT_THAT(led->why, HasSubstr("a LED of 1.5 mm at 483 mm"));
  EXPECT_THAT(led->why, HasSubstr("no shading changes"));
  EXPECT_EQ(led->bound_sigma, 0);

  const Scene deep = family(Family::kDeep);
  left_out.clear();
  EXPECT_TRUE(effects_within(deep, *rig_of(deep), 0.01, left_out).finite_led);
  EXPECT_GT(bound_of(deep, "finite_led").sigma, 100) << "a penumbra may take all light";
}

TEST(Bounds, AnIdealSceneNeedsNoEffectButItsLights) {
  Scene scene;
  scene.camera.lens = {};
  scene.camera.movement = {};
  scene.camera.vignette = {0, 0};
  scene.camera.blur = {};
  scene.camera.field = {};
  scene.camera.chromatic = {};
  scene.camera.veil = {};
  scene.camera.bloom = {};
  scene.camera.linearity = {};
  scene.camera.defects = {};
  scene.lights.led_radius_mm = scene.lights.drift = scene.lights.flicker = scene.lights.stray =
      scene.lights.ambient = 0;
  std::vector<LeftOutEffect> left_out;
  EffectSettings expected;
  expected.near_light = expected.noise = true;
  EXPECT_EQ(effects_within(scene, *rig_of(scene), 0, left_out), expected);
  EXPECT_EQ(left_out.size(), effect_keys().size() - 2);
}

TEST(Bounds, OfWhatIsLeftOutAddUpToNoMoreThanAsked) {
  const Scene scene = family(Family::kPlain);
  const SceneRig rig = *rig_of(scene);
  const EffectBounds bounds = bounds_of(scene, rig);
  std::size_t before = 0;
  for (const double to_sigma : {0.0, 0.1, 1.0, 10.0, 100.0, 1e9}) {
    std::vector<LeftOutEffect> left_out;
    const EffectSettings on = effects_within(scene, rig, to_sigma, left_out);
    double sum = 0;
    for (const LeftOutEffect& effect : left_out) sum += bounds[number_of(effect.name)].sigma;
    EXPECT_LE(sum, to_sigma);
    EXPECT_GE(left_out.size(), before);
    before = left_out.size();
    EXPECT_TRUE(on.noise);
    EXPECT_TRUE(on.near_light || !(on.relief || on.finite_led || on.vignetting));
    EXPECT_TRUE(on.relief || !(on.cast_shadows || on.interreflection));
  }
  EXPECT_EQ(before, effect_keys().size() - 1);
}

TEST(Bounds, GrowWithWhatTheyBound) {
  struct Knob {
    const char* effect;
    std::function<void(Scene&, double)> turn;  ///< from 0 to 1
  };
  const Knob knobs[] = {
      {"finite_led",
       [](Scene& s, double t) {
         s.lights.led_radius_mm = 20 * t;
         s.targets.resize(1);
       }},
      {"led_drift", [](Scene& s, double t) { s.lights.drift = 0.1 * t; }},
      {"led_drift", [](Scene& s, double t) { s.lights.flicker = 0.1 * t; }},
      {"stray", [](Scene& s, double t) { s.lights.stray = t; }},
      {"ambient", [](Scene& s, double t) { s.lights.ambient = t; }},
      {"vignetting",
       [](Scene& s, double t) {
         s.camera.vignette = {0, 0.5 * t};
       }},
      {"defocus",
       [](Scene& s, double t) {
         s.camera.blur = {1 + 4 * t, 0};
       }},
      {"translucency", [](Scene& s, double t) { s.material.translucency.share = 0.9 * t; }},
      {"field_curvature", [](Scene& s, double t) { s.camera.field.corner_px = 8 * t; }},
      {"chromatic_aberration",
       [](Scene& s, double t) {
         s.camera.chromatic = {4 * t, 0};
       }},
      {"veil", [](Scene& s, double t) { s.camera.veil.share = 0.2 * t; }},
      {"dark_current", [](Scene& s, double t) { s.camera.defects = {.dark_electrons_per_s = 1e4 * t}; }},
      {"uneven_response", [](Scene& s, double t) { s.camera.defects = {.response_percent = 5 * t}; }},
      {"nonlinearity",
       [](Scene& s, double t) {
         s.camera.linearity = {0.1 * t, 0};
       }},
      {"near_light", [](Scene& s, double t) { s.camera.mm_per_pixel = 0.01 + 0.1 * t; }},
      {"relief", [](Scene& s, double t) { s.geometry.warp_pitch_mm = s.geometry.weft_pitch_mm = 0.1 + t; }},
      {"interreflection", [](Scene& s, double t) { s.geometry.flank_deg = 10 + 20 * t; }},
  };
  for (const auto& [effect, turn] : knobs) {
    double before = 0;
    for (const double t : {0.1, 0.4, 1.0}) {
      Scene scene = family(Family::kSmooth);
      scene.lights.rings = {{2, 30, 0, 600}};
      turn(scene, t);
      const double sigma = bound_of(scene, effect).sigma;
      EXPECT_GE(sigma, before) << effect << " at " << t;
      before = sigma;
    }
    EXPECT_GT(before, 0) << effect;
  }
}

TEST(Bounds, OfASphereOnTheHorizonAreItsFormFactor) {
  for (const double sine : {0.001, 0.1, 0.5, 0.9}) {
    const double alpha = std::asin(sine);
    const double expected = (alpha - sine * std::cos(alpha)) / (kPi * sine * sine);
    EXPECT_NEAR(sphere_cosine(0, sine) / expected, 1, 1e-6);
    for (int i = -1000; i <= 1000; ++i) {
      const double c = i / 1000.0;
      ASSERT_LE(sphere_cosine(c, sine) - std::max(c, 0.0), expected * (1 + 1e-6)) << c << " under " << sine;
    }
  }
}

TEST(Bounds, OfStrayLightAreTheLightItself) {
  Scene scene;
  scene.camera.defects = {};
  scene.camera.veil = {};
  const SceneRig rig = *rig_of(scene);
  double brightest = 0;
  for (const DistantLight& led : distant_lights(rig, 0).lights)
    brightest = std::max(brightest, led.irradiance_rgb[1] * rig.exposure(100));
  const double added = 0.5 * 0.002 * brightest;
  EXPECT_NEAR(bound_of(scene, "stray").sigma, added * 40000 / std::sqrt(added * 40000 + 9), 1e-9);
}

/// What reaches the photosites, and what they make of it.
struct Picture {
  std::vector<double> before_noise;
  std::vector<double> counted;
};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) { return low + (high - low) * share_(engine_); }
  bool in_percent(double percent) { return between(0, 1) < percent * kPercent; }
  int below(int n) { return std::min(static_cast<int>(between(0, n)), n - 1); }
  /// Often none at all.
  double up_to(double most) { return in_percent(25) ? 0 : between(0, most); }
  Rgb colour() { return {between(0, 1), between(0, 1), between(0, 1)}; }
  Spectrum spectrum() {
    Spectrum s;
    for (double& sample : s.samples) sample = between(0.05, 1);
    return s;
  }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<double> share_{0, 1};
};

void draw_camera(Random& r, Scene& s) {
  CameraSettings& c = s.camera;
  c.width = 32;
  c.height = 24;
  c.mm_per_pixel = std::exp(r.between(std::log(0.2), std::log(5)));
  c.body = r.in_percent(50) ? Body::kOffset : Body::kD5100;
  c.read_noise_electrons = r.between(0.5, 10);
  c.iso = r.in_percent(70) ? 100 : 800;
  c.albedo_at_full = r.between(0.3, 1);
  if (r.in_percent(30)) c.pose = {r.between(0, 25), r.between(0, 360), r.between(0, 90), 2, -3};
  if (r.in_percent(80)) c.lens = {.k1 = r.between(-0.2, 0.1)};
  if (r.in_percent(20)) c.lens.offset_x_px = r.between(-3, 3);
  c.movement = {r.up_to(0.2), r.up_to(0.2)};
  c.vignette = {r.up_to(6), r.up_to(0.4)};
  c.blur = {r.up_to(2), r.up_to(0.6)};
  c.field = {r.up_to(3)};
  c.chromatic = {r.up_to(3), -r.up_to(3)};
  c.veil = {r.up_to(0.05), r.between(0.05, 1)};
  c.bloom = {r.up_to(1), r.between(0, 0.4)};
  c.linearity = {r.between(-0.1, 0.1), r.between(-0.05, 0.05)};
  c.defects = {.dark_electrons_per_s = r.up_to(500), .temperature_c = r.between(10, 40)};
  c.defects.response_percent = r.up_to(2);
  c.defects.column_counts = r.up_to(3);
  c.defects.photosite_counts = r.up_to(3);
  c.defects.hot_per_million = r.in_percent(40) ? 1e4 : 0;
  c.defects.dead_per_million = r.in_percent(40) ? 1e4 : 0;
}

void draw_cloth(Random& r, Scene& s) {
  const int kind = r.below(6);
  constexpr Family kFamilies[] = {Family::kSmooth, Family::kPlain, Family::kDeep};
  if (kind > 2) s.geometry = family_settings(kFamilies[kind - 3]);
  if (kind == 1) s.geometry.kind = GeometryKind::kTilted;
  if (kind == 2) s.geometry.kind = r.in_percent(50) ? GeometryKind::kTwill : GeometryKind::kKnit;
  s.geometry.tilt_deg = r.between(0, 60);
  s.geometry.azimuth_deg = r.between(0, 360);
  s.geometry.cloth_height_mm = r.up_to(20);
  const double pitch_mm = s.camera.mm_per_pixel * r.between(1, 5);
  s.geometry.warp_pitch_mm = s.geometry.weft_pitch_mm = pitch_mm;
  s.geometry.wale_mm = s.geometry.course_mm = 2 * pitch_mm;
  if (r.in_percent(20))
    s.geometry.waves = {{s.camera.mm_per_pixel, 12 * s.camera.mm_per_pixel, r.between(0, 360)}};

  if (is_woven(s.geometry.kind)) {
    if (r.in_percent(50)) s.material.weft_albedo = r.colour();
    s.material.yarn_variation = r.up_to(0.3);
  }
  s.material.translucency.share = r.up_to(0.9);
  s.material.translucency.mean_mm = s.camera.mm_per_pixel * r.between(0.2, 2);
  if (is_woven(s.geometry.kind) && r.in_percent(30)) s.material.translucency.weft_share = r.up_to(0.9);
  s.spectra.led = r.spectrum();
  s.spectra.filters = {r.spectrum(), r.spectrum(), r.spectrum()};
  if (r.in_percent(50)) {
    s.material.dye = r.spectrum();
  } else {
    s.material.albedo = r.colour();
  }
  if (r.in_percent(10)) s.material.reflectance = Ggx{};
  if (r.in_percent(10)) s.material.reflectance = OrenNayar{};
  if (r.in_percent(15)) {
    TargetSettings& card = s.targets.emplace_back();
    card.pattern = PaperSettings{8 * s.camera.mm_per_pixel, 8 * s.camera.mm_per_pixel};
    card.centre_mm = {0, 0, s.geometry.cloth_height_mm + 40};
    card.tilt_deg = r.up_to(30);
    card.sheet.non_lambertian = r.between(-0.5, 1);
  }
}

void draw_lights(Random& r, Scene& s) {
  constexpr double kLobes[] = {0, 0.5, 1, 4};
  s.lights.mu = kLobes[r.below(4)];
  s.lights.led_radius_mm = r.up_to(8);
  s.lights.drift = r.up_to(0.1);
  s.lights.flicker = r.up_to(0.01);
  s.lights.stray = r.up_to(0.05);
  s.lights.ambient = r.up_to(0.05);
  s.lights.rings = {{2, r.between(20, 78), r.between(0, 360), r.between(250, 800)}};
  s.transport = {4, 4, 1 + r.below(2)};
}

using Flag = bool EffectSettings::*;

/// Keeps to what check_scene asks of effects that need others.
void settle(const Scene& scene, EffectSettings& on) {
  on.noise = false;
  on.spectral = on.spectral && scene.material.dye;
  on.relief = on.relief && on.near_light;
  on.finite_led = on.finite_led && on.near_light;
  on.vignetting = on.vignetting && on.near_light;
  on.cast_shadows = on.cast_shadows && on.relief;
  on.interreflection = on.interreflection && on.relief;
}

Scene random_scene(Random& r) {
  Scene s;
  s.seed = r.below(1000);
  draw_camera(r, s);
  draw_cloth(r, s);
  draw_lights(r, s);
  for (const EffectKey& key : effect_keys()) s.effects.*key.on = r.in_percent(45);
  s.effects.near_light = r.in_percent(90);
  s.effects.relief = r.in_percent(80);
  if (r.in_percent(20)) s.effects.relief = s.effects.finite_led = s.effects.vignetting = false;
  s.effects.interreflection = r.in_percent(25);
  settle(s, s.effects);
  return s;
}

/// Nothing for a scene that cannot be simulated: a lens that folds, or shadows that are too long.
std::optional<Picture> picture_of(const Scene& scene) {
  const Result<SceneRig> rig = rig_of(scene);
  if (!rig) return std::nullopt;
  Result<PassList> list = build_passes(scene, *rig, Output::kCounts);
  if (!list || list->halo > 60) return std::nullopt;
  Picture picture;
  std::vector<Pass>& passes = list->passes;
  EXPECT_EQ(passes.back().name, "converter");
  passes.pop_back();
  const auto after_noise = std::find_if(passes.begin(), passes.end(), [](const Pass& pass) {
    return pass.name == "nonlinearity" || pass.name == "black pattern";
  });
  const auto keep = [](std::vector<double>& all) {
    return [&all](const PassTile& tile) { all.insert(all.end(), tile.samples.begin(), tile.samples.end()); };
  };
  passes.insert(after_noise, {"keep", "keeps samples", PassStage::kShot, keep(picture.before_noise)});
  const std::vector<int> shots = {1, 2, 0};
  PassRunner runner(std::move(*list), {512, 512, 1});
  const Result<void> ran = runner.run(
      {0, 0, scene.camera.width, scene.camera.height}, shots, {}, [](const PassTile&) {},
      keep(picture.counted));
  EXPECT_TRUE(ran) << ran.error().message();
  return picture;
}

/// In sigma, as bounds.h has it.
double largest_change(const Picture& a, const Picture& b, bool comes_after_noise, const Sensor& sensor) {
  const double n = sensor.electrons_at_white, r = sensor.read_noise_electrons;
  const auto clipped = [](double sample) { return std::clamp(sample, 0.0, 1.0); };
  double largest = 0;
  for (std::size_t i = 0; i < a.counted.size(); ++i) {
    const double brighter = clipped(std::max(a.before_noise[i], b.before_noise[i]));
    const double change = comes_after_noise
                              ? std::abs(clipped(a.counted[i]) - clipped(b.counted[i]))
                              : std::abs(clipped(a.before_noise[i]) - clipped(b.before_noise[i]));
    EXPECT_FALSE(std::isnan(a.counted[i]) || std::isnan(b.counted[i]));
    largest = std::max(largest, change * n / std::sqrt(brighter * n + r * r));
  }
  return largest;
}

// So many random scenes, or as many as the environment asks for.
int scenes_to_draw() {
  const char* asked = std::getenv("WEFT_SCENES");
  return asked == nullptr ? 80 : std::atoi(asked);
}

TEST(Bounds, HoldForEveryEffectOfRandomScenes) {
  struct Account {
    int compared = 0;
    int changed = 0;
    double closest = 0;  ///< largest change over its bound
  };
  std::map<std::string, Account> accounts;
  Random r(20240229);
  for (int scenes = 0, drawn = 0; scenes < scenes_to_draw(); ++drawn) {
    ASSERT_LT(drawn, 10 * scenes_to_draw()) << "hardly a scene can be simulated";
    Scene with = random_scene(r);
    const EffectSettings all = with.effects;
    with.effects.nonlinearity = false;
    const std::optional<Picture> picture = picture_of(with);
    if (!picture) continue;
    ++scenes;
    const SceneRig rig = *rig_of(with);
    const EffectBounds bounds = bounds_of(with, rig);
    ASSERT_EQ(bounds.size(), effect_keys().size());
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      const Flag effect = effect_keys()[i].on;
      if (!(all.*effect)) continue;
      Scene without = with;
      without.effects.*effect = effect == &EffectSettings::nonlinearity;  // the one that is off in `with`
      EffectSettings settled = without.effects;
      settle(without, settled);
      if (!(settled == without.effects)) continue;  // another effect needs it
      const std::optional<Picture> other = picture_of(without);
      if (!other) continue;
      const bool comes_after_noise =
          effect == &EffectSettings::nonlinearity || effect == &EffectSettings::uneven_response;
      const double change = largest_change(*picture, *other, comes_after_noise, rig.sensor);
      EXPECT_LE(change, bounds[i].sigma * (1 + 1e-9) + 1e-6)
          << effect_keys()[i].name << " of scene " << drawn << ": " << bounds[i].why;
      Account& account = accounts[effect_keys()[i].name];
      ++account.compared;
      account.changed += change > 1e-6;
      account.closest = std::max(account.closest, bounds[i].sigma > 1e-6 ? change / bounds[i].sigma : 0);
    }
  }
  for (const EffectKey& key : effect_keys()) {
    const Account& account = accounts[key.name];
    std::printf("%-16s compared %3d times, changed %3d, at most %.3f of its bound\n", key.name,
                account.compared, account.changed, account.closest);
    const bool has_bound = key.on != &EffectSettings::noise;
    EXPECT_EQ(account.changed > 0, has_bound) << key.name;
  }
}

}  // namespace
}  // namespace weft::simulator
