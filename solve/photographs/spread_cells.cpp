// SPDX-License-Identifier: Apache-2.0
#include "solve/photographs/spread_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"

namespace weft::solve {
namespace {

constexpr double kMostReadings = 2e6;
constexpr int kMostColumns = 64, kFewestColumns = 8;
constexpr int kRowsAtATime = 16;  // of cells
constexpr int kGreen = 1;

// The mean of a cell's greens; infinity where one is full, NaN where one is missing.
float green_of(View<const float> plane, const Planes& planes, int y, int frame_y) {
  float sum = 0;
  int sites = 0;
  for (int j = 0; j < kCellSide; ++j) {
    for (int i = 0; i < kCellSide; ++i) {
      if (planes.count == 1 && planes.cfa.channel_at(i, frame_y + j) != kGreen) continue;
      sum += plane(i, y + j);
      ++sites;
    }
  }
  return sites == 0 ? std::numeric_limits<float>::quiet_NaN() : sum / static_cast<float>(sites);
}

}  // namespace

std::vector<int> columns_of_cells(const Photographs& photographs) {
  const int rows = photographs.size.height / kCellSide, cells = photographs.size.width / kCellSide;
  const double affordable =
      kMostReadings / std::max(1.0, static_cast<double>(rows) * static_cast<double>(photographs.count()));
  const int count = std::min(cells, std::clamp(static_cast<int>(affordable), kFewestColumns, kMostColumns));
  std::vector<int> columns;
  for (int i = 0; i < count; ++i) columns.push_back((2 * i + 1) * cells / (2 * count) * kCellSide);
  return columns;
}

solver::FrameCells spread_cells(const Photographs& photographs, int threads) {
  const std::vector<int> columns = columns_of_cells(photographs);
  const Planes planes = photographs.planes();
  solver::FrameCells cells;
  cells.columns = static_cast<int>(columns.size());
  cells.rows = photographs.size.height / kCellSide;
  cells.count = photographs.count();
  const std::size_t readings = cells.cells() * cells.count;
  cells.value.resize(readings);
  cells.strength.resize(readings);
  cells.direction.resize(readings);
  const int bands = (cells.rows + kRowsAtATime - 1) / kRowsAtATime;
  parallel_for(static_cast<std::size_t>(bands), threads, [&](std::size_t band, int) {
    const int from = static_cast<int>(band) * kRowsAtATime, to = std::min(from + kRowsAtATime, cells.rows);
    Image<float> scratch({kCellSide, kCellSide * (to - from)});
    for (std::size_t k = 0; k < cells.count; ++k) {
      for (int i = 0; i < cells.columns; ++i) {
        const int x = columns[static_cast<std::size_t>(i)];
        const Rect part = {x, kCellSide * from, x + kCellSide, kCellSide * to};
        const auto views = readings_of(photographs.frames, k, part, scratch.plane());
        const View<const float> plane = views[planes.count == 1 ? 0 : kGreen];
        for (int row = from; row < to; ++row) {
          const int y = kCellSide * row;
          const std::size_t at = cells.cell_at(i, row) * cells.count + k;
          const LightField::Light light = photographs.field->at(k, kGreen, x, y);
          const float reading = green_of(plane, planes, y - part.y0, y);
          const auto strength = static_cast<float>(light.strength);
          const bool is_there = strength > 0 && std::isfinite(reading);
          cells.value[at] = is_there ? reading / strength : std::numeric_limits<float>::quiet_NaN();
          cells.strength[at] = strength;
          cells.direction[at] = light.direction;
        }
      }
    }
  });
  return cells;
}

}  // namespace weft::solve
