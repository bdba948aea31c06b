// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "simulator/scene/scene.h"
#include "tests/core/places.h"

namespace weft::simulator {

inline const std::filesystem::path kSource = source_folder();

inline const std::vector<Reflectance> kModels = {
    Lambert{},   Ggx{},           AnisotropicGgx{}, Beckmann{}, BlinnPhong{}, Cloth{}, MultipleScattering{},
    OrenNayar{}, DisneyDiffuse{}, FibreCones{},     MixedGgx{}};

/// Every kind, as many as there are models.
inline const std::vector<GeometryKind> kKinds = {
    GeometryKind::kFlat,      GeometryKind::kTilted, GeometryKind::kPlain,  GeometryKind::kTwill,
    GeometryKind::kSatin,     GeometryKind::kKnit,   GeometryKind::kSphere, GeometryKind::kCylinder,
    GeometryKind::kHeightMap, GeometryKind::kPlain,  GeometryKind::kSatin};

inline Scene parsed(const std::string& toml) {
  Result<Scene> scene = parse_scene(toml, "scene.toml");
  EXPECT_TRUE(scene) << scene.error().message() << "\n" << toml;
  return scene ? *scene : Scene();
}

inline std::string refusal(const std::string& toml) {
  const Result<Scene> scene = parse_scene(toml, "scene.toml");
  if (scene) return "nothing was refused";
  EXPECT_EQ(scene.error().kind, ErrorKind::kBadData);
  return scene.error().message();
}

inline Spectrum rising_spectrum(double first) {
  Spectrum s;
  for (std::size_t i = 0; i < Spectrum::kSamples; ++i)
    s.samples[i] = first + 0.01 * static_cast<double>(i) / 3;
  return s;
}

/// A geometry of that kind in which no value is as it is by default.
inline GeometrySettings every_geometry(GeometryKind kind) {
  GeometrySettings g;
  g.kind = kind;
  g.cloth_height_mm = 1.5;
  if (kind == GeometryKind::kTilted) g.tilt_deg = 33;
  if (kind == GeometryKind::kTilted || kind == GeometryKind::kCylinder) g.azimuth_deg = -71;
  if (is_woven(kind)) {
    g.warp_pitch_mm = 0.3;
    g.weft_pitch_mm = 0.31;
    g.crimp = 0.05;
    g.flank_deg = 41;
    g.twist_relief = 0.01;
    g.flatness = 0.1;
    g.fibre_relief = 0.002;
    g.fibre_spacing = 0.09;
    g.fibre_angle_deg = -19;
    g.fibre_seed = 7;
  }
  if (kind == GeometryKind::kTwill || kind == GeometryKind::kSatin) g.over = 3, g.under = 2, g.step = 2;
  if (kind == GeometryKind::kKnit) {
    g.wale_mm = 1.1;
    g.course_mm = 0.8;
    g.yarn_diameter = 0.4;
    g.loop_flank_deg = 55;
  }
  if (kind == GeometryKind::kSphere || kind == GeometryKind::kCylinder) g.radius_mm = 12, g.contact_deg = 70;
  if (kind == GeometryKind::kHeightMap) {
    g.heights_file = "/somewhere/heights \"1\".exr";
    g.height_map = {0.2, 1, -2, 45, false};
  }
  g.folds = {{2, 30, 10, 5}, {3, 20, -10, 6}};
  g.waves = {{0.25, 70, 80, 90}};
  return g;
}

/// A cloth in which no value is as it is by default; even numbers have colours, odd ones spectra.
inline MaterialSettings every_material(std::size_t number) {
  MaterialSettings m;
  if (number % 2 == 0) {
    m.albedo = {0.7, 0.8, 0.9};
  } else {
    m.dye = rising_spectrum(0.1);
  }
  if (is_woven(kKinds[number])) {
    if (number % 2 == 0) {
      m.warp_albedo = Rgb{0.1, 0.2, 0.3};
      m.weft_albedo = Rgb{0.4, 0.5, 0.6};
    } else {
      m.warp_dye = rising_spectrum(0.2);
      m.weft_dye = rising_spectrum(0.3);
    }
    m.stripe_yarns = 3;
    m.yarn_variation = 0.02;
  }
  m.print.file = "/somewhere/print.png";
  m.print.placement = {0.3, -1, 2, -45, false};
  m.translucency = {0.1, 0.25, {}, {}, {}, {}};
  if (is_woven(kKinds[number])) m.translucency = {0.1, 0.25, 0.3, 0.4, 0.35, 0.45};
  const Rgb f0 = {0.05, 0.06, 0.07};
  const std::vector<Reflectance> models = {Lambert{},
                                           Ggx{0.3, f0, Beneath::kLambert},
                                           AnisotropicGgx{0.3, 0.2, f0, Beneath::kCoupled},
                                           Beckmann{0.3, f0, Beneath::kLambert},
                                           BlinnPhong{0.3, f0, Beneath::kBalanced},
                                           Cloth{0.3, 5, f0},
                                           MultipleScattering{0.3},
                                           OrenNayar{0.3},
                                           DisneyDiffuse{0.3},
                                           FibreCones{7, 3, 20, f0, Beneath::kLambert},
                                           MixedGgx{0.3, 0.6, 0.2, f0, Beneath::kCoupled}};
  m.reflectance = models[number];
  return m;
}

/// A scene of that kind in which no value is as it is by default.
inline Scene everything(std::size_t number) {
  Scene s;
  s.fabric = "a \"quoted\" \\ name\twith a tab, caf\xC3\xA9";
  s.seed = std::int64_t{1} << 62;
  s.camera = {640,
              480,
              1.0 / 3,
              700.1,
              Body::kD5100,
              12,
              1e5,
              2.5,
              200,
              5.6,
              1234.5,
              0.3,
              {10.5, -20, 30, 1, -2},
              {-0.05, 0.03, -0.001, 0.0002, -0.0003, 4, -5},
              {true, 0.25, 0.03},
              {0.5, 0.25},
              {3, 0.1},
              {1.5, 0.7, 0.1, 9},
              {2.5},
              {-0.6, 0.8},
              {0.01, 0.2},
              {0.25, 0.4},
              {-0.02, 0.03},
              {6, 31, 7, 0.5, 0.6, 0.7, {{{1, 2}, {3, -4}}}, 21, 9999, 3, 0.125}};
  s.geometry = every_geometry(kKinds[number]);
  s.material = every_material(number);
  s.lights = {1e7 / 3, {0.4, 1.1, 0.9}, 1.2, 0.5, 0.004, 0.002, 0.003, 0.004, {}, {}};
  s.lights.rings = {{3, 40, 5, 500}, {2, 50, 6, 550}};
  s.lights.leds = {{{1, 2, 300}, Vec3{0, 0.1, -1}, 0.0, Rgb{1, 2, 3}}, {{4, 5, 600}, {}, {}, {}}};
  s.spectra.led = rising_spectrum(0.5);
  s.spectra.filters = {rising_spectrum(0.1), rising_spectrum(0.2), rising_spectrum(0.3)};
  for (int i = 0; i < 24; ++i) s.spectra.chart.push_back(rising_spectrum(0.01 * i));
  s.transport = {8, 32, 3};
  s.films = {FilmStates::kBoth, 0.02, 0.8};
  s.blade = {2, true, 3, -4, 30, 9, 150, 25, 0.05};
  s.pose = {10, 20};
  const SheetSettings sheet = {1, 70, 2, 3, 0.2, 0.25};
  s.balls = {{BallSurface::kGlossy, {4, 5, 26}, 12, 0.03, 2}};
  s.targets = {{PaperSettings{100, 50}, {1, 2, 3}, 10, 20, 30, 0.8, 0.05, sheet},
               {CheckerboardSettings{9, 6, 10, 5}, {4, 5, 6}, 11, 21, 31, 0.81, 0.051, sheet},
               {CharucoSettings{6, 4, 18, 0.7, "DICT_4X4_50", 8}, {}, 0, 0, 0, 0.9, 0.04, {}},
               {GreyScaleSettings{{0.9, 1.0 / 3}, 10, 1, 4}, {}, 0, 0, 0, 0.9, 0.04, {}},
               {ChartSettings{20, 2, 4}, {}, 0, 0, 0, 0.9, 0.04, {}},
               {TagSettings{"DICT_APRILTAG_16h5", 3, 12, 3}, {}, 0, 0, 0, 0.9, 0.04, {}}};
  s.damage = {{DamageKind::kFade, 2, 7, 0.1, 0.9, 0.2, 0.8, 6},
              {DamageKind::kBlack, 3, 4, 0, 1, 0.5, 0.75, 12}};
  for (const EffectKey& effect : effect_keys()) s.effects.*effect.on = true;
  return s;
}

}  // namespace weft::simulator
