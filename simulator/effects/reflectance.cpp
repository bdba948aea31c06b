// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/reflectance.h"

#include "simulator/effects/effects.h"
#include "simulator/reflectance/representative_point.h"

namespace weft::simulator {
namespace {

/// A point's normal, its yarn and what is perpendicular to both.
struct Frame {
  Vec3 tangent, bitangent, normal;

  explicit Frame(const SurfacePoint& point)
      : tangent(tangent_of(point)), bitangent(cross(point.normal, tangent)), normal(point.normal) {}
  Vec3 local(Vec3 v) const { return {dot(v, tangent), dot(v, bitangent), dot(v, normal)}; }
};

/// The centre of a LED that has a size may have set while part of it still shines: the model then sees it
/// where it stood last.
constexpr double kRisenCosine = 1e-6;
Vec3 risen(Vec3 to_light) {
  to_light.z = kRisenCosine;
  return normalized(to_light);
}

/// The model as a light of that size sees it: its highlight is that much wider.
template <typename Model>
const Model& under_light_of(const Model& model, double, double) {
  return model;
}
Ggx under_light_of(Ggx model, double radius_mm, double distance_mm) {
  model.alpha = widened_alpha(model.alpha, radius_mm, distance_mm);
  return model;
}

/// What a point sends on, pi times f. Films let through another share of what is mirrored, which needs no
/// albedo, than of what is scattered.
template <typename Model>
Rgb reflected_by(const Model& model, const Rgb& albedo, Vec3 to_light, Vec3 to_view, double lobe_share) {
  Rgb reflected = model.evaluate(albedo, to_light, to_view);
  if (lobe_share != 1) {
    const Rgb mirrored = model.evaluate(Rgb{}, to_light, to_view);
    for (std::size_t c = 0; c < 3; ++c) reflected[c] += (lobe_share - 1) * mirrored[c];
  }
  for (double& f : reflected) f *= kPi;
  return reflected;
}

}  // namespace

Pass reflectance_pass(const Scene& scene, const SceneRig& rig) {
  const double radius_mm = scene.effects.finite_led ? scene.lights.led_radius_mm : 0;
  const auto pass = [&](const auto& model) -> std::function<void(PassTile&)> {
    return [model, radius_mm, lobe_share = rig.lobe_share, camera_mm = rig.camera_centre_mm(),
            unit = rig.signal_of_unit(scene.camera.iso)](PassTile& tile) {
      tile.signal_rect = tile.area;
      tile.signal.assign(tile.irradiance.size(), Rgb{});
      if (tile.led == 0) return;
      const Rgb flux = unit[static_cast<std::size_t>(tile.led - 1)];
      for (std::size_t i = 0; i < tile.signal.size(); ++i) {
        const double irradiance = tile.irradiance[i];
        if (irradiance <= 0) continue;
        Rgb reflected = tile.albedo[i];  // pi times Lambert's f
        if (tile.target.empty() || tile.target[i] == kCloth) {
          const Frame frame(tile.surface[i]);
          const Vec3 to_view = normalized(camera_mm - tile.point_mm[i]);
          Vec3 to_light = frame.local(tile.light[i].direction);
          if (to_light.z < kRisenCosine) to_light = risen(to_light);
          reflected = reflected_by(under_light_of(model, radius_mm, tile.light[i].distance_mm),
                                   tile.albedo[i], to_light, frame.local(to_view), lobe_share);
        }
        for (std::size_t c = 0; c < 3; ++c) tile.signal[i][c] = reflected[c] * irradiance * flux[c];
      }
    };
  };
  return {"reflectance", "reflects light as the material does: highlights, sheen, rough diffuse",
          PassStage::kLight, std::visit(pass, scene.material.reflectance)};
}

}  // namespace weft::simulator
