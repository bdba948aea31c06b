// SPDX-License-Identifier: Apache-2.0
#include "simulator/effects/halos.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simulator/camera/field_curvature.h"
#include "simulator/camera/lateral_colour.h"
#include "simulator/camera/optics.h"
#include "simulator/camera/saturation.h"
#include "simulator/camera/scene_camera.h"
#include "simulator/geometry/scene_surface.h"
#include "simulator/transport/diffusion.h"
#include "simulator/transport/rays.h"

namespace weft::simulator {
namespace {

/// What a look at the edge of the frame tells of the whole of it.
struct Field {
  Area area;             ///< of the table, seen by the frame
  double least_step_mm;  ///< between neighbouring pixels
};

Field field_of(const SceneRig& rig, double height_mm) {
  constexpr int kSteps = 16;
  const auto [width, height] = rig.camera.size;
  const Lens lens = *Lens::of(rig.camera);
  Field field = {{1e9, 1e9, -1e9, -1e9}, 1e9};
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      const double x = (width - 1.0) * i / kSteps, y = (height - 1.0) * j / kSteps;
      const Vec3 p = lens.point_on_plane(x, y, height_mm);
      field.area = {std::min(field.area.x0_mm, p.x), std::min(field.area.y0_mm, p.y),
                    std::max(field.area.x1_mm, p.x), std::max(field.area.y1_mm, p.y)};
      for (const Vec3 next :
           {lens.point_on_plane(x + 1, y, height_mm), lens.point_on_plane(x, y + 1, height_mm)}) {
        field.least_step_mm = std::min(field.least_step_mm, length(next - p));
      }
    }
  }
  return field;
}

/// Cotangent of the lowest elevation at which a LED stands over the field.
double longest_shadow_of_unit(const SceneRig& rig, const Area& area, double highest_mm) {
  double longest = 0;
  for (const NearLight& led : rig.leds.leds) {
    const double away_x =
        std::max(std::abs(led.position_mm.x - area.x0_mm), std::abs(led.position_mm.x - area.x1_mm));
    const double away_y =
        std::max(std::abs(led.position_mm.y - area.y0_mm), std::abs(led.position_mm.y - area.y1_mm));
    longest = std::max(longest, std::hypot(away_x, away_y) / std::max(led.position_mm.z - highest_mm, 1e-3));
  }
  return longest;
}

}  // namespace

int translucency_reach(const Scene& scene) {
  double farthest_mm = 0;
  for (const YarnTranslucency& yarn : scene.material.translucency.yarns())
    farthest_mm = std::max(farthest_mm, yarn.share > 0 ? yarn.mean_mm : 0);
  return Diffusion(farthest_mm / mm_per_pixel_of_cloth(scene)).radius();
}

Result<Halos> halos_of(const Scene& scene, const SceneRig& rig) {
  constexpr double kMargin = 0.98;  // of the step: the field is looked at here and there
  Halos halos;
  if (scene.effects.field_curvature) halos.field = FieldCurvature(scene.camera.field, rig.camera).radius();
  if (scene.effects.chromatic_aberration)
    halos.chromatic = LateralColour(scene.camera.chromatic, rig.camera).reach();
  if (scene.effects.defocus) halos.blur = blur_kernel(scene.camera.blur).radius;
  if (scene.effects.bloom) halos.bloom_rows = bloom_kernel(scene.camera.bloom).radius();
  if (scene.effects.translucency) {
    halos.translucency = translucency_reach(scene);
    if (halos.translucency > kLongestReach) {
      return Error{
          ErrorKind::kBadData, "light goes too far within the cloth", "scene",
          fmt::format("it is followed over {} pixels, {} are possible", halos.translucency, kLongestReach),
          "shorten mean_mm of material.translucency or enlarge camera.mm_per_pixel"};
    }
  }
  if (!scene.effects.cast_shadows && !scene.effects.interreflection) return halos;

  const Field field = field_of(rig, scene.geometry.cloth_height_mm);
  const HeightRange heights = heights_mm(surface_of(scene.geometry), field.area);
  const double relief_mm = std::max(heights.highest_mm - heights.lowest_mm, 0.5 * field.least_step_mm);
  const double step_mm = kMargin * field.least_step_mm;
  if (scene.effects.cast_shadows) {
    halos.shadow_mm = relief_mm * longest_shadow_of_unit(rig, field.area,
                                                         scene.geometry.cloth_height_mm + heights.highest_mm);
    halos.shadow = halo_for(halos.shadow_mm, step_mm);
    if (halos.shadow > kLongestReach) {
      return Error{ErrorKind::kBadData, "shadows are too long to be traced", "scene",
                   fmt::format("relief of {:.3g} mm casts them over {} pixels, {} are possible", relief_mm,
                               halos.shadow, kLongestReach),
                   "lower the relief, raise the LEDs or enlarge camera.mm_per_pixel"};
    }
  }
  if (scene.effects.interreflection) {
    halos.bounce_mm = std::min(kBounceOverRelief * relief_mm, kFarthestBounce * step_mm);
    halos.bounce = halo_for(halos.bounce_mm, step_mm);
    halos.bounces = scene.transport.bounces;
  }
  return halos;
}

}  // namespace weft::simulator
