// SPDX-License-Identifier: Apache-2.0
// What each effect does to the numbers of a picture, against its formula.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "simulator/build_passes.h"
#include "simulator/camera/optics.h"
#include "simulator/geometry/weave.h"
#include "simulator/light/incidence.h"
#include "simulator/simulate.h"
#include "simulator/simulation_plan.h"
#include "tests/simulator/output.h"

namespace weft::simulator {
namespace {

constexpr Rect kCentre = {1216, 800, 1248, 832};

double sum_of(const Image<double>& image, int plane) {
  double sum = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) sum += image(x, y, plane);
  }
  return sum;
}

Vec3 normal_at(const Rendering& r, int x, int y) {
  return {r.normal(x, y, 0), r.normal(x, y, 1), r.normal(x, y, 2)};
}

/// Counts of one shot, before they are rounded, of a tile at the centre.
std::vector<double> samples_of(const Scene& scene, int led) {
  const SimulationPlan plan = *plan_of(scene);
  PassList list = *build_passes(plan.scene, plan.rig, Output::kCounts);
  list.passes.pop_back();  // the converter
  std::vector<double> samples;
  PassRunner runner(std::move(list), {512, 32, 1});
  EXPECT_TRUE(runner.run(
      kCentre, {&led, 1}, {}, [](const PassTile&) {}, [&](const PassTile& tile) { samples = tile.samples; }));
  return samples;
}

TEST(SphereCosine, IsTheMeanCosineOverTheSphere) {
  for (const double sine : {0.02, 0.3, 0.8}) {
    for (double cosine = -1.1 * sine; cosine <= 1.1 * sine; cosine += 0.1 * sine) {
      // Midpoints of the cone's solid angle, projected: sum of max(0, cos) dw / (pi sine^2).
      constexpr int kSteps = 400;
      const double lowest = std::sqrt(1 - sine * sine), across = std::sqrt(1 - cosine * cosine);
      double sum = 0;
      for (int i = 0; i < kSteps; ++i) {
        const double z = lowest + (1 - lowest) * (i + 0.5) / kSteps, r = std::sqrt(1 - z * z);
        for (int j = 0; j < kSteps; ++j) {
          sum += std::max(0.0, z * cosine + r * across * std::cos(2 * kPi * (j + 0.5) / kSteps));
        }
      }
      const double mean = sum * 2 * (1 - lowest) / (kSteps * kSteps * sine * sine);
      EXPECT_NEAR(sphere_cosine(cosine, sine), mean, 2e-4 * sine) << cosine << " under a sine of " << sine;
    }
  }
}

TEST(SphereCosine, IsTheCosineAboveTheHorizonAndSetsWithoutAStep) {
  EXPECT_EQ(sphere_cosine(0.5, 0.1), 0.5);
  EXPECT_EQ(sphere_cosine(-0.2, 0.1), 0);
  EXPECT_NEAR(sphere_cosine(0.1 - 1e-12, 0.1), 0.1, 1e-9);
  EXPECT_NEAR(sphere_cosine(-0.1 + 1e-12, 0.1), 0, 1e-9);
  EXPECT_NEAR(sphere_cosine(0, 1e-6), 2 * 1e-6 / (3 * kPi), 1e-9) << "a hundred-thousandth of a small LED";
}

TEST(Effects, ASphereUnderANearLedIsTheFormulaEverywhere) {
  Scene scene = near_lit(GeometryKind::kSphere);
  scene.effects.relief = true;
  scene.camera.mm_per_pixel = 0.2;
  const Rect across = {1130, 805, 1330, 825};
  const Rendering r = render(scene, across);
  const SceneRig rig = *rig_of(scene);
  double worst = 0;
  for (int y = 0; y < across.height(); ++y) {
    for (int x = 0; x < across.width(); ++x) {
      const Vec3 foot = point_of_pixel(scene, across.x0 + x, across.y0 + y);
      const double base = -20 * std::cos(radians(85)), from_axis = std::hypot(foot.x, foot.y);
      const bool on_sphere = from_axis < 20 * std::sin(radians(85));
      const double z = on_sphere ? base + std::sqrt(400 - from_axis * from_axis) : 0;
      const Vec3 point = {foot.x, foot.y, z};
      const Vec3 n = on_sphere ? (1 / 20.0) * (point - Vec3{0, 0, base}) : Vec3{0, 0, 1};
      for (std::size_t k = 0; k < 10; ++k) {
        const NearLight& led = rig.leds.leds[k];
        const Vec3 to_led = led.position_mm - point;
        const double d = length(to_led), lobe = -dot(to_led, led.aim) / d;
        const double expected = 0.5 * led.flux_rgb[1] * lobe * std::max(0.0, dot(n, to_led)) / (d * d * d);
        worst = std::max(worst, std::abs(r.readings(x, y, static_cast<int>(3 * k + 1)) - expected) / 50);
      }
    }
  }
  EXPECT_LT(worst, 1e-6) << "of about 50, the largest reading";
}

TEST(Effects, ADistortedPixelSeesThePointThatItsBentRayMeets) {
  Scene scene = near_lit(GeometryKind::kFlat);
  scene.effects.distortion = true;
  scene.camera.lens = {.k1 = -0.4, .p1 = 0.01};
  const Rendering r = render(scene, {0, 0, 8, 8});
  const SceneRig rig = *rig_of(scene);
  const Vec3 seen = point_on_plane(rig.camera, 5, 3, 0);  // core's own inverse
  EXPECT_GT(length(seen - point_of_pixel(scene, 5, 3)), 0.3) << "the corner is bent by many pixels";
  const double expected = 0.5 * 2e7 * shading(incidence(rig.leds.leds[0], seen), {0, 0, 1});
  EXPECT_NEAR(r.readings(5, 3, 1) / expected, 1, 1e-9);
}

TEST(Effects, VignettingIsInTheExactCalibration) {
  Scene scene = near_lit(GeometryKind::kFlat);
  const Rendering without = render(scene, {0, 0, 4, 4});
  scene.effects.vignetting = true;
  scene.camera.vignette.corner_loss = 0.2;
  const Rendering with = render(scene, {0, 0, 4, 4});
  const SceneRig rig = *rig_of(scene);
  const NearLights lights = std::get<NearLights>(*exact_calibration(scene, rig).lights);
  const double u = 2 * 2.0 / 2463 - 1, v = 2 * 2.0 / 1631 - 1;
  const double calibrated =
      lights.leds[3].flux_rgb[1] / rig.leds.leds[3].flux_rgb[1] * std::exp(lights.log_gain(3, 1, u, v));
  EXPECT_LT(calibrated, 0.8);
  EXPECT_NEAR(with.readings(2, 2, 10) / without.readings(2, 2, 10) / calibrated, 1, 2e-4);
}

TEST(Effects, DriftFadesTheLedsAndAmbientReachesTheDarkShot) {
  Scene scene = near_lit(GeometryKind::kFlat);
  const std::vector<double> plain = samples_of(scene, 10);
  scene.effects.led_drift = true;
  scene.lights.drift = 0.04;
  scene.lights.flicker = 0;
  const std::vector<double> faded = samples_of(scene, 10);
  EXPECT_NEAR(faded[0] / plain[0], 0.96, 1e-12);
  EXPECT_EQ(samples_of(scene, 0)[0], 0);
  scene.effects.ambient = true;
  scene.lights.ambient = 0.01;
  // The exposure rule: a white of 0.99 that faces the brightest LED gives 0.90; the cloth has 0.5; red gets
  // half.
  EXPECT_NEAR(samples_of(scene, 0)[0], 0.01 * 0.5 * 0.5 * 0.90 / 0.99, 1e-5);
}

TEST(Effects, StrayLightIsAShareOfWhatTheLedGivesToWhite) {
  Scene scene = near_lit(GeometryKind::kTilted);
  scene.geometry.tilt_deg = 70;
  scene.effects.stray = true;
  scene.lights.stray = 0.02;
  const Rendering r = render(scene, kCentre);
  const SceneRig rig = *rig_of(scene);
  const Incidence light = incidence(rig.leds.leds[2], {0, 0, 0});
  EXPECT_NEAR(r.readings(5, 5, 3 * 2 + 1) / (0.5 * 0.02 * 2e7 * light.strength), 1, 1e-12)
      << "LED 3 is behind the plane: all light is stray";
}

TEST(Effects, ACastShadowTakesAllOfALedAndNothingElse) {
  Scene scene = near_lit(GeometryKind::kPlain);
  scene.geometry = family_settings(Family::kDeep);
  scene.camera.mm_per_pixel = 0.03;
  scene.effects.relief = true;
  const Rendering open = render(scene, kCentre);
  scene.effects.cast_shadows = true;
  const Rendering shadowed = render(scene, kCentre);
  int dark = 0, lit = 0;
  for (int k = 0; k < 10; ++k) {
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) {
        const double before = open.readings(x, y, 3 * k), after = shadowed.readings(x, y, 3 * k);
        ASSERT_TRUE(after == before || after == 0) << x << ", " << y << ", LED " << k + 1;
        dark += after == 0 && before > 0;
        lit += after > 0;
      }
    }
  }
  EXPECT_GT(dark, 300) << "of " << dark + lit;
  EXPECT_GT(lit, 7000);
}

TEST(Effects, InterreflectionLightensDeepClothMoreThanSmooth) {
  double gain[2];
  for (const Family family : {Family::kSmooth, Family::kDeep}) {
    Scene scene = near_lit(GeometryKind::kPlain);
    scene.geometry = family_settings(family);
    scene.camera.mm_per_pixel = 0.03;
    scene.effects.relief = true;
    const Rendering without = render(scene, kCentre);
    scene.effects.interreflection = true;
    const Rendering with = render(scene, kCentre);
    gain[family == Family::kDeep] = sum_of(with.readings, 1) / sum_of(without.readings, 1) - 1;
  }
  // The hidden share of an even white sky is 0.009 and 0.21, and half of the light is absorbed each time.
  EXPECT_GT(gain[0], 0.001);
  EXPECT_LT(gain[0], 0.009);
  EXPECT_GT(gain[1], 0.04);
  EXPECT_LT(gain[1], 0.2);
}

TEST(Effects, ReflectanceIsPiTimesTheModelInThePlaceOfLambert) {
  Scene scene = near_lit(GeometryKind::kTilted);
  const Ggx satin = {.alpha = 0.3, .f0 = {0.05, 0.05, 0.05}};
  const Rendering lambert = render(scene, kCentre);
  scene.effects.reflectance = true;
  scene.material.reflectance = satin;
  const Rendering shiny = render(scene, kCentre);
  const Vec3 n = normal_at(shiny, 7, 9);
  const Vec3 point = point_of_pixel(scene, kCentre.x0 + 7, kCentre.y0 + 9);
  const Vec3 to_led = normalized(rig_of(scene)->leds.leds[0].position_mm - point);
  const Vec3 to_view = normalized(Vec3{0, 0, 600} - point);
  const Vec3 tangent = normalized(cross({0, 1, 0}, n)), bitangent = cross(n, tangent);
  const auto local = [&](Vec3 v) { return Vec3{dot(v, tangent), dot(v, bitangent), dot(v, n)}; };
  const Rgb f = satin.evaluate({0.5, 0.5, 0.5}, local(to_led), local(to_view));
  EXPECT_NEAR(shiny.readings(7, 9, 1) / lambert.readings(7, 9, 1), kPi * f[1] / 0.5, 1e-9);
}

TEST(Effects, MovementShiftsTheClothFromShotToShotAndNotItsTruth) {
  Scene scene = near_lit(GeometryKind::kPlain);
  scene.lights.rings = {{2, 0, 0, 600}};  // the same light twice
  const Rendering still = render(scene, kCentre);
  scene.effects.movement = true;
  scene.camera.movement = {0.1, 0};
  const Rendering moved = render(scene, kCentre);
  double shot_to_shot = 0, truth = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      ASSERT_EQ(still.readings(x, y, 1), still.readings(x, y, 4));
      shot_to_shot += std::abs(moved.readings(x, y, 1) - moved.readings(x, y, 4));
      truth += std::abs(moved.normal(x, y, 0) - still.normal(x, y, 0));
    }
  }
  EXPECT_GT(shot_to_shot / (32 * 32), 0.1);
  EXPECT_EQ(truth, 0);
}

TEST(Effects, BlurKeepsTheLightAndLevelsIt) {
  Scene scene = near_lit(GeometryKind::kPlain);
  scene.material.warp_albedo = Rgb{0.1, 0.1, 0.1};
  const Rect wide = {1000, 700, 1128, 828};
  const Rendering sharp = render(scene, wide);
  scene.effects.defocus = true;
  scene.camera.blur = {.defocus_px = 4, .spread_px = 1};
  const Rendering blurred = render(scene, wide);
  EXPECT_NEAR(sum_of(blurred.readings, 1) / sum_of(sharp.readings, 1), 1, 0.01);
  const auto contrast = [](const Rendering& r) {
    double sum = 0;
    for (int x = 1; x < 128; ++x) sum += std::abs(r.readings(x, 64, 1) - r.readings(x - 1, 64, 1));
    return sum;
  };
  EXPECT_LT(contrast(blurred), 0.5 * contrast(sharp));
}

TEST(Effects, RedAndBlueAreWhatCamerasOfOtherScalesSee) {
  Scene scene = near_lit(GeometryKind::kFlat);  // waves: a weave has edges, of which pixels tell no place
  scene.geometry.waves = {{.amplitude_mm = 0.1, .wavelength_mm = 1.2, .direction_deg = 30}};
  scene.camera.width = scene.camera.height = 400;
  const double corner_px = 199.5 * std::sqrt(2);
  const auto seen_at_scale = [&](double shift_px) {
    Scene scaled = scene;
    scaled.camera.mm_per_pixel *= 1 - shift_px / corner_px;
    return render(scaled, {0, 0, 32, 32});
  };
  const Rendering green = render(scene, {0, 0, 32, 32}), red = seen_at_scale(0.8), blue = seen_at_scale(-0.5);
  scene.effects.chromatic_aberration = true;
  scene.camera.chromatic = {0.8, -0.5};
  const Rendering seen = render(scene, {0, 0, 32, 32});
  double moved = 0, off = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      ASSERT_EQ(seen.readings(x, y, 1), green.readings(x, y, 1));
      moved += std::abs(green.readings(x, y, 0) - red.readings(x, y, 0)) / 1024;
      moved += std::abs(green.readings(x, y, 2) - blue.readings(x, y, 2)) / 1024;
      off += std::abs(seen.readings(x, y, 0) - red.readings(x, y, 0)) / 1024;
      off += std::abs(seen.readings(x, y, 2) - blue.readings(x, y, 2)) / 1024;
    }
  }
  EXPECT_LT(off, 0.03 * moved) << "what is left is interpolation";
}

TEST(Effects, FieldCurvatureBlursTheCornersAndLeavesTheCentre) {
  Scene scene = near_lit(GeometryKind::kPlain);
  scene.geometry.warp_pitch_mm = scene.geometry.weft_pitch_mm = 0.8;
  const Rect corner = {0, 0, 32, 32};
  const auto contrast = [&](Rect area) {
    const Rendering r = render(scene, area);
    double sum = 0;
    for (int y = 0; y < 32; ++y)
      for (int x = 1; x < 32; ++x) sum += std::abs(r.readings(x, y, 1) - r.readings(x - 1, y, 1));
    return sum;
  };
  const double centre_before = contrast(kCentre), corner_before = contrast(corner);
  scene.effects.field_curvature = true;
  scene.camera.field.corner_px = 6;
  EXPECT_NEAR(contrast(kCentre) / centre_before, 1, 1e-6);
  EXPECT_LT(contrast(corner) / corner_before, 0.8);
}

TEST(Effects, AVeilIsItsShareOfTheMeanOfTheFrame) {
  Scene scene;  // distant light: the frame is even
  const std::vector<double> plain = samples_of(scene, 1);
  scene.effects.veil = true;
  scene.camera.veil = {0.01, 0.3};
  const std::vector<double> veiled = samples_of(scene, 1);
  EXPECT_NEAR(veiled[7] / plain[7], 1.01, 1e-9);

  scene.material.albedo = {0.04, 0.04, 0.04};
  TargetSettings sheet;  // covers the left half of the frame
  sheet.pattern = PaperSettings{1000, 1000};
  sheet.centre_mm = {-500, 0, 0};
  sheet.white = 0.84;
  scene.targets = {sheet};
  scene.camera.veil.spread = 10;  // all over the frame alike
  const double dark = samples_of(scene, 1)[31];
  scene.effects.veil = false;
  const double clean = samples_of(scene, 1)[31];
  EXPECT_NEAR(dark / clean, 1 + 0.01 * (0.84 + 0.04) / 2 / 0.04, 0.002);
}

TEST(Effects, AVeilFollowsTheLightOfItsShot) {
  Scene scene;
  scene.effects.veil = scene.effects.led_drift = scene.effects.ambient = true;
  scene.camera.veil = {0.01, 0.3};
  scene.lights.drift = 0.2;
  scene.lights.ambient = 0.01;
  for (const int led : {0, 1, 10}) {
    const std::vector<double> veiled = samples_of(scene, led);
    scene.effects.veil = false;
    EXPECT_NEAR(veiled[7] / samples_of(scene, led)[7], 1.01, 1e-9) << "LED " << led;
    scene.effects.veil = true;
  }
}

TEST(Effects, TranslucencyKeepsTheLightAndSoftensTheEdgesOfShadows) {
  Scene scene = near_lit(GeometryKind::kPlain);
  scene.geometry = family_settings(Family::kDeep);
  scene.camera.mm_per_pixel = 0.04;
  scene.effects.relief = scene.effects.cast_shadows = true;
  const Rect wide = {1100, 700, 1228, 828};
  const Rendering opaque = render(scene, wide);
  scene.effects.translucency = true;
  scene.material.translucency = {0.3, 0.12, {}, {}, {}, {}};
  const Rendering soft = render(scene, wide);
  const int low = 3 * 5 + 1;  // LED 6 stands at 62 degrees
  EXPECT_NEAR(sum_of(soft.readings, low) / sum_of(opaque.readings, low), 1, 0.01) << "but for the border";
  int dark = 0, still_dark = 0;
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) {
      dark += opaque.readings(x, y, low) == 0;
      still_dark += soft.readings(x, y, low) == 0;
    }
  }
  EXPECT_GT(dark, 1000);
  EXPECT_EQ(still_dark, 0);
}

TEST(Effects, TranslucencyChangesNothingWhereLightIsEven) {
  Scene scene;
  const std::vector<double> opaque = samples_of(scene, 3);
  scene.effects.translucency = true;
  scene.material.translucency = {0.5, 1, {}, {}, {}, {}};
  const std::vector<double> translucent = samples_of(scene, 3);
  for (std::size_t i = 0; i < opaque.size(); ++i) ASSERT_NEAR(translucent[i] / opaque[i], 1, 1e-12);
}

TEST(Effects, LightThatEntersTheWeftLeavesTheWarpToo) {
  Scene scene = near_lit(GeometryKind::kPlain);
  scene.geometry.warp_pitch_mm = scene.geometry.weft_pitch_mm = 0.8;
  const Rect wide = {1100, 700, 1228, 828};
  const Rendering opaque = render(scene, wide);
  scene.effects.translucency = true;
  scene.material.translucency = {0, 0.3, {}, 0.5, {}, {}};
  const Rendering soft = render(scene, wide);
  const Weave weave(scene.geometry);
  double gained[2] = {};
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) {
      const Vec3 p = point_of_pixel(scene, wide.x0 + x, wide.y0 + y);
      gained[weave.at(p.x, p.y).yarn.is_weft] += soft.readings(x, y, 1) - opaque.readings(x, y, 1);
    }
  }
  EXPECT_GT(gained[0], 0);
  EXPECT_NEAR(gained[1] / gained[0], -1, 0.05) << "what the weft gives away, the warp gets";
}

TEST(Effects, LightMayNotGoTooFarWithinTheCloth) {
  Scene scene;
  scene.effects.translucency = true;
  scene.material.translucency = {0.2, 0.3, {}, {}, {}, {}};
  scene.camera.mm_per_pixel = 0.001;
  const Result<PassList> list = build_passes(scene, *rig_of(scene), Output::kCounts);
  ASSERT_FALSE(list);
  EXPECT_NE(list.error().message().find("light goes too far within the cloth"), std::string::npos);
}

TEST(Effects, SensorFaultsAreWhatTheirSettingsSay) {
  Scene scene = near_lit(GeometryKind::kFlat);
  scene.effects.dark_current = true;
  scene.camera.defects = {.dark_electrons_per_s = 1e5};
  const double exposure_s = rig_of(scene)->exposure_us * 1e-6;
  EXPECT_NEAR(samples_of(scene, 0)[40], 1e5 * exposure_s / 40000, 1e-12);

  scene = near_lit(GeometryKind::kFlat);
  const std::vector<double> straight = samples_of(scene, 1);
  scene.effects.nonlinearity = true;
  scene.camera.linearity = {0.1, 0.05};
  const std::vector<double> bent = samples_of(scene, 1);
  const double v = bent[33];
  EXPECT_NEAR(v * (1 + 0.1 * v + 0.05 * v * v), straight[33], 1e-12);
  EXPECT_EQ(exact_calibration(scene, *rig_of(scene)).response->linearity[2][1], 0.05);

  scene = near_lit(GeometryKind::kFlat);
  scene.effects.uneven_response = true;
  scene.camera.defects = {.response_percent = 2, .column_counts = 3};
  const std::vector<double> uneven = samples_of(scene, 1);
  double squares = 0;
  for (std::size_t i = 0; i < uneven.size(); ++i) squares += std::pow(uneven[i] / straight[i] - 1, 2);
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(uneven.size())), 0.02, 0.002);
}

TEST(Effects, ACheckerboardLiesOnTheTableWhereItIsPut) {
  Scene scene = near_lit(GeometryKind::kFlat);
  scene.material.albedo = {0.2, 0.2, 0.2};
  TargetSettings board;
  board.pattern = CheckerboardSettings{};
  board.white = 0.8;
  board.black = 0.05;
  scene.targets = {board};
  scene.camera.width = 616;
  scene.camera.height = 408;
  scene.camera.mm_per_pixel = 0.32;
  const Rendering r = render(scene, {0, 0, 616, 408});
  int white = 0, black = 0, table = 0;
  for (int y = 0; y < 408; ++y) {
    for (int x = 0; x < 616; ++x) {
      const double albedo = r.albedo(x, y, 1);
      white += std::abs(albedo - 0.8) < 1e-12;
      black += std::abs(albedo - 0.05) < 1e-12;
      table += std::abs(albedo - 0.2) < 1e-12;
    }
  }
  const double pixels_a_square = 15 * 15 / (0.32 * 0.32);
  EXPECT_NEAR(black / pixels_a_square, 35, 3) << "35 of 70 squares are black, less the pixels of their edges";
  EXPECT_GT(white, black);
  EXPECT_GT(table, 10000);
}

TEST(Effects, ASpectralCameraSeesADyeAsItsFiltersDoAndTruthAsTheObserver) {
  Scene scene = near_lit(GeometryKind::kFlat);
  Spectrum red = flat_spectrum(0.1);
  for (std::size_t i = 22; i < Spectrum::kSamples; ++i) red.samples[i] = 0.8;  // from 600 nm on
  scene.material.dye = red;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < 12; ++i) scene.spectra.filters[2 - c].samples[12 * c + i] = 1;
  }
  const Rendering observer = render(scene, kCentre);
  scene.effects.spectral = true;
  const Rendering camera = render(scene, kCentre);
  EXPECT_EQ(camera.albedo(3, 3, 1), observer.albedo(3, 3, 1));
  const double seen = camera.readings(3, 3, 1) / observer.readings(3, 3, 1) * observer.albedo(3, 3, 1);
  EXPECT_NEAR(seen, (10 * 0.1 + 2 * 0.8) / 12, 1e-12) << "the green filter passes 500 to 610 nm alike";
}

}  // namespace
}  // namespace weft::simulator
