// SPDX-License-Identifier: Apache-2.0
#include "solver/kernels/linear.h"

#include <vector>

#include "solver/kernels/rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/kernels/linear.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first.
#include <hwy/highway.h>

#include "solver/kernels/linear-inl.h"

#if HWY_ONCE
namespace weft::solver {

HWY_EXPORT(solve_mosaic_row);
HWY_EXPORT(solve_rgb_row);
HWY_EXPORT(solve_bare_row);

void solve_linear(const TileInput& input, const TileOutput& output, const LinearOptions& options) {
  solve_rows(
      input, output,
      {.planes = input.planes,
       .shadow_mask = options.shadow_mask,
       .noise = input.noise,
       .plane_weights = input.plane_weights},
      input.planes == 1 ? HWY_DYNAMIC_DISPATCH(solve_mosaic_row) : HWY_DYNAMIC_DISPATCH(solve_rgb_row));
}

void solve_bare(Rect tile, std::span<const View<const float>> readings, const LightField& field,
                const std::array<View<float>, 3>& normal, const std::array<View<float>, 3>& albedo) {
  std::vector<RowLight> lights;
  write_row_lights(field, lights);
  std::vector<const float*> rows(readings.size());
  RowPoints points;
  RowTask task;
  task.lights = lights.data();
  task.light_count = lights.size();
  task.readings = rows.data();
  task.points = &points;
  task.width = static_cast<std::size_t>(tile.width());
  for (int y = 0; y < tile.height(); ++y) {
    points.read(field, tile.y0 + y, tile.x0, tile.x1);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = readings[i].row(y);
    for (std::size_t c = 0; c < 3; ++c) {
      task.normal[c] = normal[c].row(y);
      task.albedo[c] = albedo[c].row(y);
    }
    HWY_DYNAMIC_DISPATCH(solve_bare_row)(task);
  }
}

}  // namespace weft::solver
#endif
