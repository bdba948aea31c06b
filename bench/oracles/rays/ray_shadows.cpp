// SPDX-License-Identifier: Apache-2.0
#include "bench/oracles/rays/ray_shadows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "solver/transport/light_cells.h"
#include "solver/transport/planes.h"

namespace weft::test {
namespace {

using namespace solver;

constexpr int kCell = LightDirections::kCell;
static_assert(kCell == kPacket, "a packet of pixels lies in one cell of directions");

/// Sixteen pixels of a row, aligned in the picture, of which those inside the tile take part.
struct ShadowRun {
  int x, y;
  int begin, end;  ///< lanes inside the tile
};

struct RunNormals {
  alignas(64) float x[kPacket], y[kPacket], z[kPacket];
};

void start_run(const HeightGrid& grid, Rect tile, const Normals& normals, const ShadowRun& run, RunNormals& n,
               RayPacket& rays) {
  for (int lane = run.begin; lane < run.end; ++lane) {
    const int column = run.x + lane - tile.x0, row = run.y - tile.y0;
    n.x[lane] = normals.x(column, row);
    n.y[lane] = normals.y(column, row);
    n.z[lane] = normals.z(column, row);
    rays.start_x[lane] = static_cast<float>(run.x + lane);
    rays.start_y[lane] = static_cast<float>(-run.y);
    rays.start_z[lane] = grid.relief().z_px(run.x + lane, run.y) + HeightGrid::kLift;
  }
}

/// Aims at one light. A ray ends above the relief or at its reach.
/// @return the pixels that face the light, a bit each
std::uint32_t aim_run(const ShadowRun& run, const RunNormals& n,
                      const std::array<LightCells::Direction, kCell>& to_light, float top_px, float reach_px,
                      RayPacket& rays) {
  std::uint32_t facing = 0;
  for (int lane = 0; lane < kPacket; ++lane) {
    rays.is_active[lane] = 0;
    if (lane < run.begin || lane >= run.end) continue;
    const LightCells::Direction l = to_light[static_cast<std::size_t>(lane)];
    if (!(n.x[lane] * l.x + n.y[lane] * l.y + n.z[lane] * l.z > 0)) continue;
    facing |= 1U << lane;
    const float rise_px = top_px - rays.start_z[lane];
    if (rise_px <= 0 && l.z >= 0) continue;  // from the top of the cloth
    rays.is_active[lane] = -1;
    rays.direction_x[lane] = l.x;
    rays.direction_y[lane] = l.y;
    rays.direction_z[lane] = l.z;
    const float reach = reach_px / std::sqrt(l.x * l.x + l.y * l.y);
    rays.length[lane] = l.z > 0 ? std::min(rise_px / l.z, reach) : reach;
  }
  return facing;
}

/// Calls seen(run, word, bits) for each run and 32 lights of a tile; blocked(rays) answers for a packet.
template <typename Blocked, typename Seen>
void trace(const HeightGrid& grid, Rect tile, const Normals& normals, const LightDirections& lights,
           int reach_px, const Blocked& blocked, const Seen& seen) {
  const LightCells cells(lights, tile, grid.relief().height_mm.size());
  const float top_px = grid.relief().top_px();
  RunNormals n;
  RayPacket rays;
  std::array<LightCells::Direction, kCell> to_light;
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0 / kPacket * kPacket; x < tile.x1; x += kPacket) {
      const ShadowRun run = {x, y, std::max(tile.x0 - x, 0), std::min(tile.x1 - x, kPacket)};
      start_run(grid, tile, normals, run, n, rays);
      for (std::size_t first = 0; first < lights.count; first += 32) {
        std::array<std::uint32_t, kPacket> bits = {};
        for (std::size_t k = first; k < std::min(first + 32, lights.count); ++k) {
          cells.read(k, x, y, to_light);
          const std::uint32_t facing = aim_run(run, n, to_light, top_px, static_cast<float>(reach_px), rays);
          const std::uint32_t lit = facing == 0 ? 0 : facing & ~blocked(rays);
          for (std::size_t lane = 0; lane < kPacket; ++lane) bits[lane] |= ((lit >> lane) & 1) << (k - first);
        }
        seen(run, first / 32, bits);
      }
    }
  }
}

Result<void> check(const HeightGrid& grid, Rect tile, const Normals& normals, const LightDirections& lights,
                   int reach_px, std::span<const View<std::uint32_t>> visible) {
  if (auto checked = check_tile(grid, tile, reach_px); !checked) return checked;
  if (auto checked = check_normals(normals, tile); !checked) return checked;
  return check_visibility(tile, lights, visible);
}

}  // namespace

Result<void> find_visible_lights(const HeightGrid& grid, Rect tile, const Normals& normals,
                                 const LightDirections& lights, int reach_px,
                                 std::span<const View<std::uint32_t>> visible) {
  if (auto checked = check(grid, tile, normals, lights, reach_px, visible); !checked) return checked;
  trace(
      grid, tile, normals, lights, reach_px, [&](const RayPacket& rays) { return grid.occlude(rays); },
      [&](const ShadowRun& run, std::size_t word, const std::array<std::uint32_t, kPacket>& bits) {
        std::uint32_t* row = visible[word].row(run.y - tile.y0);
        for (int lane = run.begin; lane < run.end; ++lane) {
          row[run.x + lane - tile.x0] = bits[static_cast<std::size_t>(lane)];
        }
      });
  return {};
}

std::vector<RayPacket> shadow_packets(const HeightGrid& grid, Rect tile, const Normals& normals,
                                      const LightDirections& lights, int reach_px) {
  std::vector<RayPacket> packets;
  trace(
      grid, tile, normals, lights, reach_px,
      [&](const RayPacket& rays) {
        packets.push_back(rays);
        return 0U;
      },
      [](const ShadowRun&, std::size_t, const std::array<std::uint32_t, kPacket>&) {});
  return packets;
}

}  // namespace weft::test
