// SPDX-License-Identifier: Apache-2.0
#include "simulator/build_passes.h"

#include <algorithm>
#include <utility>

#include "simulator/effects/effects.h"
#include "simulator/effects/halos.h"

namespace weft::simulator {
namespace {

bool has_own_law(const Scene& scene) {
  return std::any_of(scene.targets.begin(), scene.targets.end(),
                     [](const TargetSettings& target) { return target.sheet.non_lambertian != 0; });
}

/// The scene as a veil needs it: without what spreads light by less than a veil does and without rays, whose
/// price it would double.
Scene without_detail(Scene scene) {
  EffectSettings& on = scene.effects;
  on.cast_shadows = on.interreflection = on.translucency = false;
  on.field_curvature = on.defocus = on.chromatic_aberration = on.veil = on.noise = false;
  scene.damage.clear();
  return scene;
}

/// A list of passes under construction.
class Builder {
 public:
  Builder(const Scene& scene, const SceneRig& rig, Output output, const Halos& halos)
      : scene_(scene), rig_(rig), output_(output), halos_(halos) {}

  PassList build() && {
    add_cloth();
    if (output_ == Output::kSurface) return std::move(list_);
    add_rays();
    add_light();
    add_reflection();
    add_lens();
    output_ == Output::kCounts ? add_photosites() : add_colours();
    list_.halo = halos_.all();
    list_.leds = static_cast<int>(rig_.leds.leds.size());
    list_.cloth_moves = on().movement;
    return std::move(list_);
  }

 private:
  const EffectSettings& on() const { return scene_.effects; }
  bool moves() const { return on().movement && output_ != Output::kSurface; }
  void add(Pass pass, const char* effect = "") {
    pass.effect = effect;
    list_.passes.push_back(std::move(pass));
  }

  void add_cloth() {
    const bool seen_by_camera = output_ != Output::kSurface;
    add(camera_pass(scene_, rig_), on().distortion ? "distortion" : "");
    if (moves()) add(onto_moved_cloth_pass(scene_), "movement");
    add(geometry_pass(scene_));
    add(is_woven(scene_.geometry.kind) ? dye_pass(scene_, seen_by_camera)
                                       : albedo_pass(scene_, seen_by_camera));
    if (scene_.material.print.albedo) add(print_pass(scene_));
    if (moves()) add(back_from_moved_cloth_pass(scene_), "movement");
    if (on().relief) add(relief_pass(), "relief");
    if (output_ == Output::kSurface && !scene_.targets.empty())
      add(targets_pass(scene_, rig_, seen_by_camera));
    if (output_ == Output::kSurface && !scene_.balls.empty()) add(balls_pass(scene_, rig_));
  }

  void add_rays() {
    if (on().cast_shadows || on().interreflection)
      add(mesh_pass(), on().cast_shadows ? "cast_shadows" : "interreflection");
    if (on().interreflection) add(bounces_pass(scene_, halos_), "interreflection");
    if (!scene_.targets.empty()) add(targets_pass(scene_, rig_, true));
    if (!scene_.balls.empty()) add(balls_pass(scene_, rig_));
    if (rig_.blade_lies) add(blade_pass(scene_, rig_));
    if (output_ == Output::kCounts && has_photosites())
      add(photosites_pass(scene_, halos_), photosites_effect());
  }

  void add_light() {
    if (on().finite_led) {
      add(finite_led_pass(scene_, rig_), "finite_led");
    } else {
      on().near_light ? add(near_light_pass(rig_), "near_light") : add(distant_light_pass(scene_, rig_));
    }
    if (has_own_law(scene_)) add(paper_pass(scene_));
    if (on().cast_shadows) add(cast_shadows_pass(scene_, rig_, halos_), "cast_shadows");
    if (rig_.blade_lies) add(blade_shadow_pass(scene_));
    if (!scene_.balls.empty()) add(mirrored_lamps_pass(scene_, rig_));
  }

  void add_reflection() {
    on().reflectance ? add(reflectance_pass(scene_, rig_), "reflectance") : add(lambert_pass(scene_, rig_));
    if (on().interreflection) add(interreflection_pass(scene_, rig_), "interreflection");
    if (on().translucency) add(translucency_pass(scene_, rig_, halos_), "translucency");
    if (on().led_drift) add(led_drift_pass(scene_, rig_), "led_drift");
    if (on().stray) add(stray_pass(scene_, rig_), "stray");
    if (on().ambient) add(ambient_pass(scene_, rig_), "ambient");
  }

  void add_lens() {
    if (on().vignetting) add(vignetting_pass(scene_, rig_), "vignetting");
    if (on().field_curvature) add(field_curvature_pass(scene_, rig_, halos_), "field_curvature");
    if (on().defocus) add(defocus_pass(scene_, halos_), "defocus");
    if (on().chromatic_aberration)
      add(chromatic_aberration_pass(scene_, rig_, halos_), "chromatic_aberration");
    if (on().veil) add(veil_pass(scene_, rig_, light_of_the_frame()), "veil");
  }

  PassList light_of_the_frame() const {
    const Scene scene = without_detail(scene_);
    return Builder(scene, rig_, Output::kRgb, {}).build();
  }

  bool has_photosites() const { return on().dark_current || on().uneven_response; }
  const char* photosites_effect() const { return on().dark_current ? "dark_current" : "uneven_response"; }

  void add_photosites() {
    add(mosaic_pass(halos_.bloom_rows));
    if (has_photosites()) add(expose_pass(rig_), photosites_effect());
    if (on().bloom) add(bloom_pass(scene_), "bloom");
    if (on().noise) add(noise_pass(scene_, rig_), "noise");
    if (on().nonlinearity) add(nonlinearity_pass(scene_), "nonlinearity");
    if (on().uneven_response) add(black_pattern_pass(rig_), "uneven_response");
    if (!scene_.damage.empty()) add(damage_pass(scene_));
    add(converter_pass(rig_));
  }

  void add_colours() {
    add(rgb_pass());
    if (on().noise) add(noise_pass(scene_, rig_), "noise");
    if (!scene_.damage.empty()) add(damage_pass(scene_));
  }

  const Scene& scene_;
  const SceneRig& rig_;
  Output output_;
  Halos halos_;
  PassList list_;
};

}  // namespace

Result<PassList> build_passes(const Scene& scene, const SceneRig& rig, Output output) {
  const Result<SceneRig> seen = seen_from_cloth(scene, rig);
  if (!seen) return seen.error();
  Halos halos;
  if (output != Output::kSurface) {
    const Result<Halos> needed = halos_of(scene, *seen);
    if (!needed) return needed.error();
    halos = *needed;
  }
  return Builder(scene, *seen, output, halos).build();
}

}  // namespace weft::simulator
