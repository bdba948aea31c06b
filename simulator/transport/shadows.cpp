// SPDX-License-Identifier: Apache-2.0
#include "simulator/transport/shadows.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace weft::simulator {
namespace {

int rays_to(const SphereLight& light, const RaySettings& settings) {
  return light.radius_mm > 0 ? settings.rays : 1;
}

void aim_at_light(const HeightMesh& mesh, Rect pixels, const SphereLight& light, RaySettings settings,
                  RayBatch& rays) {
  settings.rays = rays_to(light, settings);
  const auto rays_a_pixel = static_cast<std::size_t>(settings.rays);
  rays.resize(static_cast<std::size_t>(pixels.pixels()) * rays_a_pixel);
  std::size_t first = 0;
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    for (int x = pixels.x0; x < pixels.x1; ++x, first += rays_a_pixel) {
      const Vec3 start_mm = mesh.ray_start_mm(x, y);
      const Vec3 to_light = light.position_mm - start_mm;
      const double distance_mm = length(to_light);
      const Vec3 axis = distance_mm > 0 ? (1 / distance_mm) * to_light : Vec3{0, 0, 1};
      if (light.radius_mm > 0) {
        const double sine = std::min(light.radius_mm / std::max(distance_mm, light.radius_mm), 1.0);
        aim_in_cone(settings, scramble_of(settings.seed, x, y, settings.stream), start_mm, axis, sine,
                    std::max(distance_mm - light.radius_mm, 0.0), first, rays);
      } else {
        aim_along(settings, start_mm, axis, distance_mm, first, rays);
      }
    }
  }
}

}  // namespace

RayBatch shadow_rays(const HeightMesh& mesh, Rect pixels, const SphereLight& light,
                     const RaySettings& settings) {
  RayBatch rays;
  aim_at_light(mesh, pixels, light, settings, rays);
  return rays;
}

Result<Image<float>> visible_fraction(const HeightMesh& mesh, Rect pixels, const SphereLight& light,
                                      const RaySettings& settings) {
  if (auto checked = check_rays(settings); !checked) return checked.error();
  if (auto checked = check_covered(mesh, pixels); !checked) return checked.error();
  const Vec3 p = light.position_mm;
  if (!std::isfinite(p.x + p.y + p.z) || !(light.radius_mm >= 0) || !std::isfinite(light.radius_mm)) {
    return Error{ErrorKind::kBadData, "shadows cannot be traced", "light",
                 "its position or radius is not finite, or its radius negative",
                 "give a finite position and a radius from 0"};
  }
  Image<float> fraction({pixels.width(), pixels.height()});
  const int rays_a_pixel = rays_to(light, settings);
  RayBatch rays;
  std::vector<std::uint8_t> blocked;
  for_each_run(pixels, rays_a_pixel, [&](Rect run) {
    aim_at_light(mesh, run, light, settings, rays);
    blocked.resize(rays.size());
    mesh.occlude(rays, blocked);
    const std::uint8_t* b = blocked.data();
    float* row = fraction.plane().row(run.y0 - pixels.y0);
    for (int x = run.x0; x < run.x1; ++x, b += rays_a_pixel) {
      int open = 0;
      for (int i = 0; i < rays_a_pixel; ++i) open += 1 - b[i];
      row[x - pixels.x0] = static_cast<float>(open) / static_cast<float>(rays_a_pixel);
    }
  });
  return fraction;
}

}  // namespace weft::simulator
