// SPDX-License-Identifier: Apache-2.0
#include "bench/effects/patch.h"

#include <utility>
#include <variant>

#include "bench/effects/scenes.h"
#include "simulator/geometry/surface.h"

namespace weft::bench {

using namespace simulator;

Result<TracedPatch> traced_patch(int side_px) {
  constexpr double kLedRadius_mm = 12;
  constexpr std::size_t kLowLed = 4;
  Scene scene = cloth_scene(Family::kDeep, {side_px, side_px});
  scene.effects = effects_for(&EffectSettings::interreflection);
  scene.effects.cast_shadows = true;
  const Result<SceneRig> rig = rig_of(scene);
  if (!rig) return rig.error();
  const Result<Halos> halos = halos_of(scene, *rig);
  if (!halos) return halos.error();

  const Rect pixels = {0, 0, side_px, side_px}, area = grown(pixels, halos->all());
  std::vector<Vec3> points_mm, normals;
  std::visit(
      [&](const auto& surface) {
        for_each_pixel(area, [&](std::size_t, int x, int y) {
          const Vec3 p = point_of_pixel(scene, x, y);
          const SurfacePoint at = surface.at(p.x, p.y);
          points_mm.push_back(p + Vec3{0, 0, at.height_mm});
          normals.push_back(at.normal);
        });
      },
      surface_of(scene.geometry));
  Result<HeightMesh> mesh = HeightMesh::build(area, points_mm);
  if (!mesh) return mesh.error();
  const SphereLight led = {rig->leds.leds[kLowLed].position_mm, kLedRadius_mm};
  return TracedPatch{std::move(scene), *halos, pixels, std::move(*mesh), std::move(normals), led};
}

}  // namespace weft::bench
