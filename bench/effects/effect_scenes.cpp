// SPDX-License-Identifier: Apache-2.0
#include "bench/effects/effect_scenes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/reflectance/presets.h"

namespace weft::bench {
namespace {

using namespace simulator;

constexpr double kPixelsAYarn = 10;

Spectrum bell(double base, double peak, double centre_nm, double width_nm) {
  Spectrum spectrum;
  for (std::size_t i = 0; i < Spectrum::kSamples; ++i) {
    const double t = (Spectrum::nm(i) - centre_nm) / width_nm;
    spectrum.samples[i] = base + (peak - base) * std::exp(-t * t / 2);
  }
  return spectrum;
}

}  // namespace

void add_spectra(Scene& scene) {
  const Spectrum phosphor = bell(0, 0.8, 570, 60), blue = bell(0, 1, 450, 12);
  for (std::size_t i = 0; i < Spectrum::kSamples; ++i) {
    scene.spectra.led.samples[i] = std::min(1.0, phosphor.samples[i] + blue.samples[i]);
  }
  scene.spectra.filters = {bell(0, 0.9, 600, 28), bell(0, 0.9, 535, 38), bell(0, 0.9, 460, 28)};
  scene.material.warp_dye = bell(0.08, 0.7, 700, 75);
  scene.material.weft_dye = bell(0.10, 0.6, 480, 45);
}

void lay(Scene& scene, const PatternSettings& pattern) {
  TargetSettings target;
  target.pattern = pattern;
  target.centre_mm = {0, 0, 0.5};
  scene.targets.push_back(target);
}

Scene cloth_scene(Family family, Size size) {
  Scene scene;
  scene.camera.width = size.width;
  scene.camera.height = size.height;
  scene.geometry = family_settings(family);
  scene.camera.mm_per_pixel = scene.geometry.warp_pitch_mm / kPixelsAYarn;
  scene.material.reflectance = preset("satin")->reflectance;
  scene.material.translucency.share = 0.3;
  add_spectra(scene);
  return scene;
}

EffectSettings effects_for(Effect effect) {
  using E = EffectSettings;
  E effects;
  effects.*effect = true;
  if (effect == &E::cast_shadows || effect == &E::interreflection) effects.relief = true;
  effects.near_light = effects.near_light || effects.relief || effects.finite_led || effects.vignetting;
  return effects;
}

EffectSettings effects_under(Effect effect) {
  EffectSettings effects = effects_for(effect);
  effects.*effect = false;
  return effects;
}

EffectSettings all_effects() {
  EffectSettings all;
  for (const EffectKey& key : effect_keys()) all.*key.on = true;
  return all;
}

std::vector<NamedScene> auto_gallery(Size size) {
  const auto matte = [&](GeometrySettings geometry, double albedo) {
    Scene scene;
    scene.camera = cloth_scene(Family::kPlain, size).camera;
    scene.geometry = std::move(geometry);
    scene.material.albedo = {albedo, albedo, albedo};
    return scene;
  };
  const GeometrySettings smooth = family_settings(Family::kSmooth), plain = family_settings(Family::kPlain),
                         deep = family_settings(Family::kDeep);
  Scene satin = matte({}, 0.5);
  satin.geometry.kind = GeometryKind::kSatin;
  const ClothPreset sheen = *preset("satin");
  satin.material.albedo = sheen.albedo;
  satin.material.reflectance = sheen.reflectance;
  Scene dim = matte(smooth, 0.02);
  dim.camera.iso = 1600;
  Scene cotton = matte(plain, 0.8);
  cotton.material.translucency.share = 0.3;
  Scene board = matte(smooth, 0.5);
  lay(board, CheckerboardSettings{.square_mm = 1, .margin_mm = 1});
  return {{"flat card", matte({}, 0.5)},
          {"smooth, albedo 0.02, ISO 1600", dim},
          {"smooth, albedo 0.02", matte(smooth, 0.02)},
          {"smooth, albedo 0.2", matte(smooth, 0.2)},
          {"smooth, albedo 0.5", matte(smooth, 0.5)},
          {"plain, albedo 0.5", matte(plain, 0.5)},
          {"deep, albedo 0.5", matte(deep, 0.5)},
          {"plain, albedo 0.8, translucent", cotton},
          {"satin with sheen", satin},
          {"checkerboard on smooth", board}};
}

}  // namespace weft::bench
