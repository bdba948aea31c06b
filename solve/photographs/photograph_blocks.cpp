// SPDX-License-Identifier: Apache-2.0
#include "solve/photographs/photograph_blocks.h"

#include <algorithm>
#include <variant>

#include "core/base/parallel.h"
#include "solve/photographs/picture_axes.h"
#include "solver/sample_tiles.h"

namespace weft::solve {
namespace {

using solver::BlockTile;

double block_mean(View<const float> plane, int x0, int y0, int side) {
  double sum = 0;
  for (int y = y0; y < y0 + side; ++y) {
    for (int x = x0; x < x0 + side; ++x) sum += static_cast<double>(plane(x, y));
  }
  return sum / (side * side);
}

// By the axes of the picture.
Vec3 light_at(const Photographs& photographs, std::size_t k, int x, int y) {
  const bool is_mosaic = photographs.planes().count == 1;
  Vec3 sum;
  for (const int c : {0, 1, 1, 2}) {
    const LightField::Light light = photographs.field->at(k, is_mosaic ? c : 1, x, y);
    sum = sum + 0.25 * light.strength * light.direction;
  }
  return picture_from_rig(photographs.camera) * sum;
}

// Near lights differ from cell to cell of their field.
void add_lights(const Photographs& photographs, Rect part, int side, BlockTile& tile) {
  const std::size_t count = photographs.count();
  if (std::holds_alternative<DistantLights>(photographs.field->lights())) {
    for (std::size_t k = 0; k < count; ++k) tile.lights.push_back(light_at(photographs, k, part.x0, part.y0));
    return;
  }
  tile.light_step = LightField::kCell / side;
  tile.light_columns = tile.width / tile.light_step + 2;
  const int rows = tile.height / tile.light_step + 2;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < tile.light_columns; ++column) {
      const int x = std::min(part.x0 + column * LightField::kCell + side / 2, photographs.size.width - 1);
      const int y = std::min(part.y0 + row * LightField::kCell + side / 2, photographs.size.height - 1);
      for (std::size_t k = 0; k < count; ++k) tile.lights.push_back(light_at(photographs, k, x, y));
    }
  }
}

BlockTile block_tile(const Photographs& photographs, Rect part, int side) {
  BlockTile tile;
  tile.width = part.width() / side;
  tile.height = part.height() / side;
  tile.count = photographs.count();
  const Size size = photographs.size;
  tile.left = (part.x0 + 0.5 * side - 0.5 * size.width) / side;
  tile.top = (0.5 * size.height - part.y0 - 0.5 * side) / side;
  add_lights(photographs, part, side, tile);
  tile.readings.resize(static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height) *
                       tile.count);
  const auto plane = static_cast<std::size_t>(photographs.planes().speaker());
  Image<float> scratch({part.width(), part.height()});
  for (std::size_t k = 0; k < tile.count; ++k) {
    const View<const float> readings = readings_of(photographs.frames, k, part, scratch.plane())[plane];
    std::size_t at = k;
    for (int y = 0; y < tile.height; ++y) {
      for (int x = 0; x < tile.width; ++x, at += tile.count)
        tile.readings[at] = static_cast<float>(block_mean(readings, side * x, side * y, side));
    }
  }
  return tile;
}

}  // namespace

std::vector<BlockTile> block_tiles(const Photographs& photographs, int side, int threads) {
  const std::vector<Rect> parts = solver::sample_tiles(photographs.size);
  std::vector<BlockTile> tiles(parts.size());
  parallel_for(parts.size(), threads,
               [&](std::size_t i, int) { tiles[i] = block_tile(photographs, parts[i], side); });
  return tiles;
}

}  // namespace weft::solve
