// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/image/image.h"
#include "simulator/sampling/sobol.h"

// Rays of a pixel: how many, how far, and where they go.

namespace weft::simulator {

/// How many rays a pixel sends out, and how far.
struct RaySettings {
  int rays = 1;         ///< a pixel, from 1 to kMostRays; powers of two are best
  double reach_mm = 0;  ///< on the table, over 0: what is farther from the pixel's point is not met
  std::uint64_t seed = 0;
  std::uint32_t stream = 0;  ///< what tells these rays from others of the scene: the LED's number, say
};
inline constexpr int kMostRays = 1 << 20;

/// kBadData where a setting is out of its range, by name and value.
Result<void> check_rays(const RaySettings& settings);

/// The columns and rows that a tile's halo must have on each side so that no ray of `reach_mm` sees where the
/// mesh ends, if neighbours lie at least `least_step_mm` apart on the table.
int halo_for(double reach_mm, double least_step_mm);

/// Rays side by side, in the rig frame. Directions have unit length; a ray meets nothing beyond `length_mm`.
struct RayBatch {
  std::vector<float> origin_x_mm, origin_y_mm, origin_z_mm;
  std::vector<float> direction_x, direction_y, direction_z;
  std::vector<float> length_mm;

  std::size_t size() const { return length_mm.size(); }
  void resize(std::size_t rays);
};

/// Writes a batch's ray `first` from `start_mm` along the unit vector `axis`, until settings.reach_mm on the
/// table or `longest_mm`.
void aim_along(const RaySettings& settings, Vec3 start_mm, Vec3 axis, double longest_mm, std::size_t first,
               RayBatch& rays);

/// The same for rays `first` to `first + settings.rays`, about the axis by scrambled Sobol points.
/// aim_in_cone: evenly over the solid angle of a cone with this sine of its half angle.
/// aim_by_cosine: over the hemisphere with density cos / pi, from points of the disc (Malley's method, Pharr,
/// Jakob and Humphreys, "Physically based rendering", 3rd edition, section 13.6.3).
void aim_in_cone(const RaySettings& settings, Scramble scramble, Vec3 start_mm, Vec3 axis, double sine,
                 double longest_mm, std::size_t first, RayBatch& rays);
void aim_by_cosine(const RaySettings& settings, Scramble scramble, Vec3 start_mm, Vec3 axis,
                   std::size_t first, RayBatch& rays);

/// Calls body(part) for the parts of `pixels`, in order: runs of a row with about kRaysAtOnce rays in all, so
/// that a batch stays in the first-level cache.
inline constexpr int kRaysAtOnce = 1024;
template <typename Body>
void for_each_run(Rect pixels, int rays_a_pixel, const Body& body) {
  const int columns = kRaysAtOnce > rays_a_pixel ? kRaysAtOnce / rays_a_pixel : 1;
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    for (int x = pixels.x0; x < pixels.x1; x += columns) {
      body(Rect{x, y, x + columns < pixels.x1 ? x + columns : pixels.x1, y + 1});
    }
  }
}

}  // namespace weft::simulator
