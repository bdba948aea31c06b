// SPDX-License-Identifier: Apache-2.0
#include "bench/oracles/rays/gather.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/vec.h"
#include "solver/transport/planes.h"

namespace weft::test {
namespace {

/// A vector of the lattice in steps of 1 / R.
struct Step {
  int u, v;
};

/// Squared length where the lattice lies as directions do: u is the squared radius in a disc and v the turn,
/// so that at the radius with half of the disc inside a step of v is 2 pi times one of u.
double squared(Step s) {
  return s.u * s.u + 4 * kPi * kPi * s.v * s.v;
}

double product(Step a, Step b) {
  return a.u * b.u + 4 * kPi * kPi * a.v * b.v;
}

/// The two shortest vectors that span the lattice, the shorter first (Gauss's reduction).
std::pair<Step, Step> reduced_basis(int points, int a) {
  Step shorter = {0, points}, longer = {1, a};
  while (squared(longer) < squared(shorter)) {
    std::swap(shorter, longer);
    const int times = static_cast<int>(std::lround(product(shorter, longer) / squared(shorter)));
    longer = {longer.u - times * shorter.u, longer.v - times * shorter.v};
  }
  return {shorter, longer};
}

using namespace solver;

/// A point of the lattice as rays need it: turn, and place in the disc by its squared radius.
struct Ray {
  float squared_radius;
  float cosine, sine;
};

std::vector<Ray> rays_of(const Lattice& lattice) {
  std::vector<Ray> rays;
  for (const TorusPoint& p : lattice.points) {
    const double turn = 2 * kPi * static_cast<double>(p.v);
    rays.push_back({p.u, static_cast<float>(std::cos(turn)), static_cast<float>(std::sin(turn))});
  }
  return rays;
}

/// Sixteen pixels of a row, aligned in the picture: where their rays start and the axes about which they go.
struct GatherRun {
  int x, y;
  int begin, end;  ///< lanes inside the tile
  alignas(64) float right_x[kPacket], right_y[kPacket], right_z[kPacket];
  alignas(64) float up_x[kPacket], up_y[kPacket], up_z[kPacket];
  alignas(64) float normal_x[kPacket], normal_y[kPacket], normal_z[kPacket];
  alignas(64) float shift[kPacket];  ///< of the squared radius
};

/// Axes about the normal, without a jump as long as normals look up (Duff et al., "Building an orthonormal
/// basis, revisited", JCGT 6(1), 2017, eq. 4), turned by the pixel's share of the shift.
void set_axes(Vec3 n, TorusPoint shift, int lane, GatherRun& run) {
  const double a = -1 / (1 + n.z), b = n.x * n.y * a;
  const Vec3 right = {1 + n.x * n.x * a, b, -n.x}, up = {b, 1 + n.y * n.y * a, -n.y};
  const double turn = 2 * kPi * static_cast<double>(shift.v);
  const Vec3 turned_right = std::cos(turn) * right + std::sin(turn) * up;
  const Vec3 turned_up = std::cos(turn) * up - std::sin(turn) * right;
  const auto set = [lane](Vec3 v, float* x, float* y, float* z) {
    x[lane] = static_cast<float>(v.x);
    y[lane] = static_cast<float>(v.y);
    z[lane] = static_cast<float>(v.z);
  };
  set(turned_right, run.right_x, run.right_y, run.right_z);
  set(turned_up, run.up_x, run.up_y, run.up_z);
  set(n, run.normal_x, run.normal_y, run.normal_z);
  run.shift[lane] = shift.u;
}

void start_run(const HeightGrid& grid, Rect tile, const Normals& normals, const Lattice& lattice,
               GatherRun& run, RayPacket& rays) {
  for (int lane = 0; lane < kPacket; ++lane) {
    // Lanes outside the tile take the nearest pixel inside, so that vectors are whole; they are not traced.
    const int x = std::clamp(run.x + lane, tile.x0, tile.x1 - 1);
    set_axes(normal_or_up(normals, x - tile.x0, run.y - tile.y0), shift_of(lattice, hash_of(x, run.y)), lane,
             run);
    rays.start_x[lane] = static_cast<float>(x);
    rays.start_y[lane] = static_cast<float>(-run.y);
    rays.start_z[lane] = grid.relief().z_px(x, run.y) + HeightGrid::kLift;
    rays.is_active[lane] = lane >= run.begin && lane < run.end ? -1 : 0;
  }
}

/// By Malley's method: a point of the disc under the hemisphere (Pharr, Jakob and Humphreys, "Physically
/// based rendering", 3rd edition, section 13.6.3). Rays end above the relief or at their reach.
void aim_run(const GatherRun& run, const Ray& ray, float top_px, float reach_px, RayPacket& rays) {
  for (int lane = 0; lane < kPacket; ++lane) {
    float squared_radius = ray.squared_radius + run.shift[lane];
    squared_radius += squared_radius < 0 ? 1.0f : 0.0f;
    squared_radius -= squared_radius > 1 ? 1.0f : 0.0f;
    const float radius = std::sqrt(squared_radius);
    const float a = radius * ray.cosine, b = radius * ray.sine, c = std::sqrt(1 - squared_radius);
    const float x = a * run.right_x[lane] + b * run.up_x[lane] + c * run.normal_x[lane];
    const float y = a * run.right_y[lane] + b * run.up_y[lane] + c * run.normal_y[lane];
    const float z = a * run.right_z[lane] + b * run.up_z[lane] + c * run.normal_z[lane];
    const float rise_px = std::max(top_px - rays.start_z[lane], 0.0f);
    const float over_top = z > 0 ? rise_px / z : std::numeric_limits<float>::max();
    rays.direction_x[lane] = x;
    rays.direction_y[lane] = y;
    rays.direction_z[lane] = z;
    rays.length[lane] = std::min(reach_px / std::sqrt(x * x + y * y), over_top);
  }
}

/// The pixel nearest to where a ray goes along one axis, of those that are a whole number of steps away.
int pixel_met(int from, float along_px, int step, int last) {
  const auto steps = static_cast<int>(std::lrint(along_px / static_cast<float>(step)));
  const int at = from + step * steps;
  if (at > last) return at - step;
  return at < 0 ? at + step : at;
}

/// All rays of a tile: intersect(rays, distance) answers for a packet; met(lane, x, y) for each ray that
/// meets the cloth, at the nearest pixel; done(run) once all rays of a run are traced.
template <typename Intersect, typename Met, typename Done>
void trace(const HeightGrid& grid, Rect tile, const Normals& normals, const GatherSettings& settings,
           const Intersect& intersect, const Met& met, const Done& done) {
  const Lattice lattice = make_lattice(settings.rays);
  const std::vector<Ray> directions = rays_of(lattice);
  const Rect pixels = grid.relief().pixels();
  const float top_px = grid.relief().top_px(), reach_px = static_cast<float>(settings.reach_px);
  const int step = settings.mosaic ? 2 : 1;
  GatherRun run;
  RayPacket rays;
  alignas(64) float distance[kPacket];
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0 / kPacket * kPacket; x < tile.x1; x += kPacket) {
      run.x = x;
      run.y = y;
      run.begin = std::max(tile.x0 - x, 0);
      run.end = std::min(tile.x1 - x, kPacket);
      start_run(grid, tile, normals, lattice, run, rays);
      for (const Ray& direction : directions) {
        aim_run(run, direction, top_px, reach_px, rays);
        intersect(rays, distance);
        for (int lane = run.begin; lane < run.end; ++lane) {
          if (!(distance[lane] <= rays.length[lane])) continue;
          met(lane, pixel_met(x + lane, distance[lane] * rays.direction_x[lane], step, pixels.x1 - 1),
              pixel_met(y, -distance[lane] * rays.direction_y[lane], step, pixels.y1 - 1));
        }
      }
      done(run);
    }
  }
}

Result<void> check_settings(const GatherSettings& settings) {
  if (settings.rays >= 1 && settings.rays <= kMostRays) return {};
  return bad_transport("rays", fmt::format("{} rays a pixel", settings.rays),
                       fmt::format("ask for from 1 to {}", kMostRays));
}

Result<void> check_radiosity(const Relief& relief, Rect tile, int reach_px, const Radiosity& radiosity,
                             std::span<const View<float>> arriving) {
  const Rect needed = within_reach(relief, tile, reach_px);
  const auto count = static_cast<std::size_t>(std::max(radiosity.count, 0));
  if (count == 0 || !holds_pixels(radiosity.area, needed) ||
      radiosity.values.size() != count * static_cast<std::size_t>(radiosity.area.pixels())) {
    return bad_transport("radiosity",
                         fmt::format("{} numbers, {} a pixel, for columns {} to {} and rows {} to {}",
                                     radiosity.values.size(), radiosity.count, radiosity.area.x0,
                                     radiosity.area.x1, radiosity.area.y0, radiosity.area.y1),
                         fmt::format("give what columns {} to {} and rows {} to {} send back", needed.x0,
                                     needed.x1, needed.y0, needed.y1));
  }
  if (arriving.size() != count ||
      !std::ranges::all_of(arriving, [&](const auto& plane) { return holds_tile(plane, tile); })) {
    return bad_transport("arriving light",
                         fmt::format("{} planes for {} numbers a pixel, or planes smaller than the tile",
                                     arriving.size(), radiosity.count),
                         fmt::format("give {} planes of the tile's size", radiosity.count));
  }
  return {};
}

}  // namespace

Lattice make_lattice(int points) {
  int best = 0;
  for (int a = 1; a < points; ++a) {
    if (squared(reduced_basis(points, a).first) > squared(reduced_basis(points, best).first)) best = a;
  }
  Lattice lattice;
  const auto scaled = [points](int u, int v) {
    return TorusPoint{static_cast<float>(u) / static_cast<float>(points),
                      static_cast<float>(v) / static_cast<float>(points)};
  };
  for (int i = 0; i < points; ++i) lattice.points.push_back(scaled(i, i * best % points));
  const auto [shorter, longer] = reduced_basis(points, best);
  lattice.cell = {scaled(shorter.u, shorter.v), scaled(longer.u, longer.v)};
  return lattice;
}

Result<void> gather_light(const HeightGrid& grid, Rect tile, const Normals& normals,
                          const Radiosity& radiosity, const GatherSettings& settings,
                          std::span<const View<float>> arriving) {
  if (auto checked = check_settings(settings); !checked) return checked;
  if (auto checked = check_tile(grid, tile, settings.reach_px); !checked) return checked;
  if (auto checked = check_normals(normals, tile); !checked) return checked;
  if (auto checked = check_radiosity(grid.relief(), tile, settings.reach_px, radiosity, arriving); !checked) {
    return checked;
  }
  const auto count = static_cast<std::size_t>(radiosity.count);
  const auto width = static_cast<std::size_t>(radiosity.area.width());
  std::vector<float> sums(kPacket * count);
  const float share = 1 / static_cast<float>(settings.rays);
  bool is_finite = true;
  trace(
      grid, tile, normals, settings,
      [&](const RayPacket& rays, float* distance) { grid.intersect(rays, distance); },
      [&](int lane, int x, int y) {
        const std::size_t pixel = static_cast<std::size_t>(y - radiosity.area.y0) * width +
                                  static_cast<std::size_t>(x - radiosity.area.x0);
        const float* from = &radiosity.values[pixel * count];
        float* to = &sums[static_cast<std::size_t>(lane) * count];
        for (std::size_t k = 0; k < count; ++k) to[k] += from[k];
      },
      [&](const GatherRun& run) {
        for (std::size_t k = 0; k < count; ++k) {
          float* row = arriving[k].row(run.y - tile.y0) + (run.x - tile.x0);
          for (int lane = run.begin; lane < run.end; ++lane) {
            row[lane] = share * sums[static_cast<std::size_t>(lane) * count + k];
            is_finite = is_finite && std::isfinite(row[lane]);
          }
        }
        std::ranges::fill(sums, 0.0f);
      });
  if (is_finite) return {};
  return bad_transport("radiosity", "what a pixel sends back is not finite",
                       "replace readings that cannot be used");
}

Result<void> trace_openness(const HeightGrid& grid, Rect tile, const Normals& normals,
                            const GatherSettings& settings, View<float> openness) {
  if (auto checked = check_settings(settings); !checked) return checked;
  if (auto checked = check_tile(grid, tile, settings.reach_px); !checked) return checked;
  if (auto checked = check_normals(normals, tile); !checked) return checked;
  if (!holds_tile(openness, tile)) {
    return bad_transport("openness", "the plane is smaller than the tile", "give a plane of the tile's size");
  }
  int meetings[kPacket] = {};
  trace(
      grid, tile, normals, settings,
      [&](const RayPacket& rays, float* distance) { grid.intersect(rays, distance); },
      [&](int lane, int, int) { ++meetings[lane]; },
      [&](const GatherRun& run) {
        float* row = openness.row(run.y - tile.y0) + (run.x - tile.x0);
        for (int lane = run.begin; lane < run.end; ++lane) {
          row[lane] = 1 - static_cast<float>(meetings[lane]) / static_cast<float>(settings.rays);
        }
        std::fill_n(meetings, kPacket, 0);
      });
  return {};
}

std::vector<RayPacket> gather_packets(const HeightGrid& grid, Rect tile, const Normals& normals,
                                      const GatherSettings& settings) {
  std::vector<RayPacket> packets;
  trace(
      grid, tile, normals, settings,
      [&](const RayPacket& rays, float* distance) {
        packets.push_back(rays);
        std::fill_n(distance, kPacket, std::numeric_limits<float>::infinity());
      },
      [](int, int, int) {}, [](const GatherRun&) {});
  return packets;
}

}  // namespace weft::test
