// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "simulator/camera/scene_camera.h"
#include "simulator/effects/effects.h"

namespace weft::simulator {
namespace {

/// A blade in the frame of its cloth.
class LevelBlade {
 public:
  LevelBlade(const BladeSettings& blade, double cloth_height_mm)
      : blade_(blade),
        z_mm_(cloth_height_mm + blade.height_mm),
        along_{std::cos(radians(blade.turn_deg)), std::sin(radians(blade.turn_deg)), 0} {}

  double z_mm() const { return z_mm_; }
  const BladeSettings& settings() const { return blade_; }

  /// Share of a disc in its plane that the blade covers, exact beside one edge.
  double covers(Vec3 centre_mm, double radius_mm) const {
    const Vec3 from_edge = {centre_mm.x - blade_.x_mm, centre_mm.y - blade_.y_mm, 0};
    const double along = dot(from_edge, along_), across = along_.x * from_edge.y - along_.y * from_edge.x;
    return beyond(across, radius_mm) * beyond(blade_.width_mm - across, radius_mm) *
           beyond(blade_.length_mm / 2 - std::abs(along), radius_mm);
  }

 private:
  /// Share of a disc that lies beyond a line, whose middle does so by `d`.
  static double beyond(double d, double radius) {
    if (radius <= 0) return d > 0 ? 1 : 0;
    const double t = std::clamp(d / radius, -1.0, 1.0);
    return 0.5 + (std::asin(t) + t * std::sqrt(1 - t * t)) / kPi;
  }

  BladeSettings blade_;
  double z_mm_;
  Vec3 along_;
};

}  // namespace

Pass blade_pass(const Scene& scene, const SceneRig& rig) {
  return {"blade", "lays the blade over the cloth", PassStage::kSurface,
          [blade = LevelBlade(scene.blade, scene.geometry.cloth_height_mm), lens = *Lens::of(rig.camera),
           is_alone = scene.targets.empty() && scene.balls.empty()](PassTile& tile) {
            if (is_alone) tile.target.assign(tile.surface.size(), kCloth);
            for_each_pixel(tile.area, [&](std::size_t i, int x, int y) {
              const Vec3 seen_mm = lens.point_on_plane(x, y, blade.z_mm());
              const Vec3 next_mm = lens.point_on_plane(x + 1, y, blade.z_mm());
              const double coverage = blade.covers(seen_mm, length(next_mm - seen_mm) / 2);
              if (coverage <= 0) return;
              for (double& albedo : tile.albedo[i]) albedo += coverage * (blade.settings().albedo - albedo);
              if (coverage < 0.5) return;
              tile.target[i] = kBlade;
              tile.point_mm[i] = seen_mm;
              tile.surface[i] = {};
              tile.surface[i].normal = {0, 0, 1};
            });
          }};
}

Pass blade_shadow_pass(const Scene& scene) {
  const double led_radius_mm = scene.effects.finite_led ? scene.lights.led_radius_mm : 0;
  return {"blade's shadow", "takes from each point the share of the LED that the blade hides",
          PassStage::kLight,
          [blade = LevelBlade(scene.blade, scene.geometry.cloth_height_mm), led_radius_mm](PassTile& tile) {
            if (tile.led == 0) return;
            for (std::size_t i = 0; i < tile.irradiance.size(); ++i) {
              const Incidence& light = tile.light[i];
              const double above_mm = blade.z_mm() - tile.point_mm[i].z;
              if (tile.target[i] == kBlade || above_mm <= 0 || light.direction.z <= 0) continue;
              const double way_mm = above_mm / light.direction.z;
              const double radius_mm = light.distance_mm > 0 ? led_radius_mm * way_mm / light.distance_mm : 0;
              tile.irradiance[i] *= 1 - blade.covers(tile.point_mm[i] + way_mm * light.direction, radius_mm);
            }
          }};
}

}  // namespace weft::simulator
