// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulator/effects/halos.h"
#include "simulator/effects/passes.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_rig.h"

// The passes, in the order of light: cloth, LED, cloth again, lens, sensor. Each copies what it needs of
// scene and rig. The plain passes below run for every scene; every other one is an effect that a scene names.

namespace weft::simulator {

// Cloth, once a tile.
Pass camera_pass(const Scene& scene, const SceneRig& rig);
Pass onto_moved_cloth_pass(const Scene& scene);  ///< movement: rig to cloth, before the cloth is looked up
Pass geometry_pass(const Scene& scene);
Pass albedo_pass(const Scene& scene, bool seen_by_camera);  ///< plain: one albedo
Pass dye_pass(const Scene& scene, bool seen_by_camera);     ///< in its place where yarns have colours
Pass print_pass(const Scene& scene);
Pass back_from_moved_cloth_pass(const Scene& scene);  ///< movement: cloth to rig, after it
Pass relief_pass();
Pass mesh_pass();
Pass bounces_pass(const Scene& scene, const Halos& halos);
Pass targets_pass(const Scene& scene, const SceneRig& rig, bool seen_by_camera);
Pass balls_pass(const Scene& scene, const SceneRig& rig);  ///< numbered after the targets
Pass blade_pass(const Scene& scene, const SceneRig& rig);

// Light of the shot's LED: fills `light` and `irradiance`.
Pass distant_light_pass(const Scene& scene, const SceneRig& rig);  ///< plain
Pass near_light_pass(const SceneRig& rig);
Pass finite_led_pass(const Scene& scene, const SceneRig& rig);
Pass paper_pass(const Scene& scene);
Pass mirrored_lamps_pass(const Scene& scene, const SceneRig& rig);  ///< highlights of balls
Pass blade_shadow_pass(const Scene& scene);
Pass cast_shadows_pass(const Scene& scene, const SceneRig& rig, const Halos& halos);

// From irradiance to signal.
Pass lambert_pass(const Scene& scene, const SceneRig& rig);  ///< plain
Pass reflectance_pass(const Scene& scene, const SceneRig& rig);
Pass translucency_pass(const Scene& scene, const SceneRig& rig, const Halos& halos);
Pass interreflection_pass(const Scene& scene, const SceneRig& rig);
Pass led_drift_pass(const Scene& scene, const SceneRig& rig);
Pass stray_pass(const Scene& scene, const SceneRig& rig);
Pass ambient_pass(const Scene& scene, const SceneRig& rig);

// Lens.
Pass vignetting_pass(const Scene& scene, const SceneRig& rig);
Pass field_curvature_pass(const Scene& scene, const SceneRig& rig, const Halos& halos);
Pass defocus_pass(const Scene& scene, const Halos& halos);
Pass chromatic_aberration_pass(const Scene& scene, const SceneRig& rig, const Halos& halos);
Pass veil_pass(const Scene& scene, const SceneRig& rig, PassList light);  ///< of what a frame's `light` gives

// Photosites.
Pass photosites_pass(const Scene& scene, const Halos& halos);
Pass mosaic_pass(int halo_rows);  ///< plain; keeps rows above and below the tile
Pass rgb_pass();                  ///< in its place for Output::kRgb
Pass expose_pass(const SceneRig& rig);
Pass bloom_pass(const Scene& scene);
Pass noise_pass(const Scene& scene, const SceneRig& rig);
Pass nonlinearity_pass(const Scene& scene);
Pass black_pattern_pass(const SceneRig& rig);
Pass damage_pass(const Scene& scene);
Pass converter_pass(const SceneRig& rig);  ///< plain

}  // namespace weft::simulator
