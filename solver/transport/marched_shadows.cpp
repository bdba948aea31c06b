// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/marched_shadows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "solver/transport/light_cells.h"
#include "solver/transport/planes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/transport/marched_shadows.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first.
#include <hwy/highway.h>

#include "solver/transport/heights-inl.h"

#ifndef WEFT_SOLVER_TRANSPORT_MARCHED_SHADOWS
#define WEFT_SOLVER_TRANSPORT_MARCHED_SHADOWS
namespace weft::solver {
namespace march {

inline constexpr double kStep_px = 0.5;

// The pixels of a cell in one row, and the way from them to one light.
struct Run {
  const float* height;  // at the first pixel
  std::ptrdiff_t stride;
  float top_px;
  double right, down;                                  // of a step of one pixel along the middle direction
  int steps;                                           // as far as light is followed
  std::array<float, LightCells::kCell> tan_elevation;  // 0 and less where the light is at the horizon
  std::array<float, LightCells::kCell> hidden;         // 1 or 0, written
};

}  // namespace march
}  // namespace weft::solver
#endif

HWY_BEFORE_NAMESPACE();
namespace weft::solver {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void march_run(march::Run& run) {
  const LaneTag d;
  for (std::size_t lane = 0; lane < run.hidden.size(); lane += hn::Lanes(d)) {
    const float* here = run.height + lane;
    const Lanes z = hn::Add(hn::LoadU(d, here), hn::Set(d, kLift));
    const Lanes tan_elevation = hn::LoadU(d, run.tan_elevation.data() + lane);
    const Lanes top = hn::Set(d, run.top_px);
    auto hidden = hn::Gt(hn::Zero(d), hn::Set(d, 1.0F));
    for (int i = 1; i <= run.steps; ++i) {
      const double at = march::kStep_px * i;
      const Lanes way = hn::MulAdd(hn::Set(d, static_cast<float>(at)), tan_elevation, z);
      if (hn::AllTrue(d, hn::Or(hidden, hn::Ge(way, top)))) break;
      const PointBetween point = point_between(run.right * at, run.down * at, run.stride);
      hidden = hn::Or(hidden, hn::Gt(height_at(here, run.stride, point), way));
    }
    hn::StoreU(hn::IfThenElseZero(hidden, hn::Set(d, 1.0F)), d, run.hidden.data() + lane);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace weft::solver {
namespace {

HWY_EXPORT(march_run);

using CellDirections = std::array<LightCells::Direction, LightCells::kCell>;

// Aims the run from the pixels of a cell at a light.
void aim(const CellDirections& to_light, int reach_px, march::Run& run) {
  const LightCells::Direction middle = to_light[to_light.size() / 2];
  const double across = std::hypot(static_cast<double>(middle.x), static_cast<double>(middle.y));
  run.right = across > 0 ? static_cast<double>(middle.x) / across : 0;
  run.down = across > 0 ? -static_cast<double>(middle.y) / across : 0;
  run.steps = across > 0 ? static_cast<int>(reach_px / march::kStep_px) : 0;
  for (std::size_t lane = 0; lane < to_light.size(); ++lane) {
    const LightCells::Direction l = to_light[lane];
    run.tan_elevation[lane] = l.z / std::sqrt(l.x * l.x + l.y * l.y);
  }
}

Result<void> check_marched(const Relief& relief, Rect tile, const Normals& normals,
                           const LightDirections& lights, int reach_px,
                           std::span<const View<std::uint32_t>> visible) {
  if (!holds_pixels(relief.pixels(), tile) || reach_px < 1) {
    return bad_transport("tile", "it is not inside the picture, or nothing is in reach",
                         "ask for a tile inside the picture and a reach of at least 1 pixel");
  }
  if (auto checked = check_normals(normals, tile); !checked) return checked;
  return check_visibility(tile, lights, visible);
}

}  // namespace

Result<void> march_to_lights(const Relief& relief, Rect tile, const Normals& normals,
                             const LightDirections& lights, int reach_px,
                             std::span<const View<std::uint32_t>> visible) {
  if (auto checked = check_marched(relief, tile, normals, lights, reach_px, visible); !checked)
    return checked;
  constexpr int kCell = LightCells::kCell;
  const Rect cells = {tile.x0 / kCell * kCell, tile.y0, (tile.x1 + kCell - 1) / kCell * kCell, tile.y1};
  const int halo = reach_px + 1;
  const Rect area = {cells.x0 - halo, cells.y0 - halo, cells.x1 + halo, cells.y1 + halo};
  const Image<float> height = heights_around(relief, area);
  const LightCells directions(lights, tile, relief.height_mm.size());
  march::Run run;
  run.stride = height.plane().stride();
  run.top_px = relief.top_px();
  CellDirections to_light;
  for (int y = tile.y0; y < tile.y1; ++y) {
    const int row = y - tile.y0;
    for (const View<std::uint32_t>& words : visible) std::fill_n(words.row(row), tile.width(), 0U);
    for (int x = cells.x0; x < cells.x1; x += kCell) {
      run.height = height.plane().row(y - area.y0) + (x - area.x0);
      for (std::size_t k = 0; k < lights.count; ++k) {
        directions.read(k, x, y, to_light);
        aim(to_light, reach_px, run);
        HWY_DYNAMIC_DISPATCH(march_run)(run);
        for (int at = std::max(x, tile.x0); at < std::min(x + kCell, tile.x1); ++at) {
          const auto lane = static_cast<std::size_t>(at - x);
          const int column = at - tile.x0;
          const LightCells::Direction l = to_light[lane];
          const float cosine =
              normals.x(column, row) * l.x + normals.y(column, row) * l.y + normals.z(column, row) * l.z;
          const bool is_seen = cosine > 0 && run.hidden[lane] == 0;
          visible[k / 32].row(row)[column] |= static_cast<std::uint32_t>(is_seen) << (k % 32);
        }
      }
    }
  }
  return {};
}

}  // namespace weft::solver
#endif
