// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/bladed_frame.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/base/parallel.h"
#include "core/rig/camera.h"
#include "solve/photographs/spread_cells.h"

namespace weft::solve {
namespace {

constexpr int kRowsOfCells = 32;

// The sum of what a frame reads in each filter cell.
Image<float> cells_of(const Frames& frames, Size size, std::size_t k, int threads) {
  Image<float> cells({size.width / kCellSide, size.height / kCellSide});
  const int parts = (cells.height() + kRowsOfCells - 1) / kRowsOfCells;
  parallel_for(static_cast<std::size_t>(parts), threads, [&](std::size_t part, int) {
    const int first = static_cast<int>(part) * kRowsOfCells;
    const int last = std::min(first + kRowsOfCells, cells.height());
    const Rect rows = {0, kCellSide * first, size.width, kCellSide * last};
    Image<float> scratch({size.width, rows.height()});
    for (const View<const float>& plane : readings_of(frames, k, rows, scratch.plane())) {
      for (int y = first; y < last; ++y) {
        const float* above = plane.row(kCellSide * (y - first));
        const float* below = plane.row(kCellSide * (y - first) + 1);
        for (int x = 0; x < cells.width(); ++x) {
          const int left = kCellSide * x;
          cells(x, y) += above[left] + above[left + 1] + below[left] + below[left + 1];
        }
      }
    }
  });
  return cells;
}

}  // namespace

Result<solver::BladeShadow> read_bladed_frame(const Exposures& exposures, double pixel_mm) {
  const Photographs& photographs = exposures.photographs;
  const Shot& shot = *exposures.plan.blade;
  const std::string where = exposures.plan.session.path_of(shot).string();
  const std::size_t k = photographs.light_of(shot.led);
  if (k == photographs.count()) {
    return Error{ErrorKind::kBadData, "the picture with the blade cannot be used", where,
                 "that of its LED without the blade was left out", "lay the blade under another LED"};
  }
  const Size size = photographs.size;
  solver::BladeCells cells = {cells_of(photographs.frames, size, k, exposures.context.threads),
                              cells_of(*exposures.beside.blade, size, 0, exposures.context.threads),
                              kCellSide * pixel_mm};
  // Where shadows fall, along the picture.
  const int x = size.width / 2, y = size.height / 2;
  const Vec3 to_light = photographs.field->at(k, 1, x, y).direction;
  Vec3 right = {1, 0, 0}, down = {0, -1, 0};
  if (photographs.camera) {
    const double height_mm = photographs.field->cloth_height_mm();
    const Vec3 here = point_on_plane(*photographs.camera, x, y, height_mm);
    right = point_on_plane(*photographs.camera, x + 1, y, height_mm) - here;
    down = point_on_plane(*photographs.camera, x, y + 1, height_mm) - here;
  }
  cells.away_x = -dot(to_light, right), cells.away_y = -dot(to_light, down);
  Result<solver::BladeShadow> shadow = solver::read_blade_shadow(cells);
  if (shadow) return shadow;
  Error error = std::move(shadow).error();
  error.where = where;
  return error;
}

}  // namespace weft::solve
