// SPDX-License-Identifier: Apache-2.0
#include "solve/photographs/diagnosis_pixels.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "solve/photographs/tile_reader.h"
#include "solver/method.h"
#include "solver/sample_tiles.h"

namespace weft::solve {
namespace {

// One photosite, or the weighted sum of three channels over their strength.
solver::EvidenceRow row_at(const solver::TileInput& input, std::size_t k, int x, int y) {
  const int column = x - input.tile.x0, line = y - input.tile.y0;
  if (input.planes == 1) {
    const LightField::Light light = input.field->at(k, input.cfa.channel_at(x, y), x, y);
    return {light.direction, light.strength, input.readings[k](column, line)};
  }
  solver::EvidenceRow row = {{}, 1, 0};
  for (std::size_t c = 0; c < 3; ++c) {
    const LightField::Light light = input.field->at(k, static_cast<int>(c), x, y);
    row.direction = light.direction;
    row.reading += input.plane_weights[c] * input.readings[3 * k + c](column, line) / light.strength;
    if (!(light.strength > 0)) row.strength = 0;
  }
  return row;
}

// At most so many pixels, evenly.
solver::Evidence thinned(solver::Evidence all, std::size_t most) {
  const std::size_t pixels = all.pixels();
  if (pixels <= most) return all;
  for (std::size_t i = 0; i < most; ++i) {
    const std::size_t p = pixels * i / most;
    all.position[i] = all.position[p];
    all.channel[i] = all.channel[p];
    std::copy_n(all.rows.begin() + static_cast<std::ptrdiff_t>(p * all.lights), all.lights,
                all.rows.begin() + static_cast<std::ptrdiff_t>(i * all.lights));
  }
  all.position.resize(most);
  all.channel.resize(most);
  all.rows.resize(most * all.lights);
  return all;
}

}  // namespace

solver::Evidence read_evidence(const Photographs& photographs) {
  const std::size_t most = std::clamp<std::size_t>(32000 / photographs.count(), 400, 1600);
  solver::Evidence all;
  all.lights = photographs.count();
  all.noise = photographs.noise();
  const std::vector<Rect> tiles = solver::sample_tiles(photographs.size);
  // A mask may leave little of the frame.
  const int step = solver::sample_step(tiles, 8 * most);
  const Planes planes = photographs.planes();
  TileReader reader(photographs, {.width = solver::kSampleTile, .height = solver::kSampleTile});
  for (const Rect& tile : tiles) {
    const solver::TileInput input = reader.read(tile);
    for (int y = tile.y0; y < tile.y1; y += step) {
      for (int x = tile.x0; x < tile.x1; x += step) {
        const std::size_t begin = all.rows.size();
        for (std::size_t k = 0; k < all.lights; ++k) {
          all.rows.push_back(row_at(input, k, x, y));
        }
        const auto first = all.rows.begin() + static_cast<std::ptrdiff_t>(begin);
        const auto usable =
            std::count_if(first, all.rows.end(), [](const auto& row) { return std::isfinite(row.reading); });
        if (usable >= 3) {
          all.position.push_back(
              {(2.0 * x + 1) / photographs.size.width - 1, (2.0 * y + 1) / photographs.size.height - 1});
          all.channel.push_back(planes.channel_at(planes.speaker(), x, y));
        } else {
          all.rows.resize(begin);
        }
      }
    }
  }
  return thinned(std::move(all), most);
}

}  // namespace weft::solve
