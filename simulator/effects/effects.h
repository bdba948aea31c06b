// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulator/passes.h"
#include "simulator/scene/rig.h"
#include "simulator/scene/scene.h"

// The passes, in the order of light: cloth, LED, cloth again, lens, sensor. Each copies what it needs of scene
// and rig. The plain passes below run for every scene; every other one is an effect that a scene names.

namespace weft::simulator {

// Cloth, once a tile.
Pass camera_pass(const Scene& scene, const Rig& rig);
Pass geometry_pass(const Scene& scene);
Pass albedo_pass(const Scene& scene);  ///< plain: one albedo
Pass dye_pass(const Scene& scene);     ///< in its place where yarns have colours
Pass relief_pass();

// Light of the shot's LED: fills `light` and `irradiance`.
Pass distant_light_pass(const Scene& scene, const Rig& rig);  ///< plain
Pass near_light_pass(const Rig& rig);
Pass finite_led_pass(const Scene& scene, const Rig& rig);

// From irradiance to signal.
Pass lambert_pass(const Scene& scene, const Rig& rig);  ///< plain
Pass led_drift_pass(const Scene& scene, const Rig& rig);
Pass stray_pass(const Scene& scene, const Rig& rig);
Pass ambient_pass(const Scene& scene, const Rig& rig);

// Photosites.
Pass mosaic_pass(int halo);  ///< plain; keeps `halo` rows and columns around the tile
Pass rgb_pass();             ///< in its place for Output::kRgb
Pass noise_pass(const Scene& scene, const Rig& rig);
Pass converter_pass(const Rig& rig);  ///< plain

}  // namespace weft::simulator
