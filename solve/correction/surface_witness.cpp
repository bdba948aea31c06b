// SPDX-License-Identifier: Apache-2.0
#include "solve/correction/surface_witness.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/parallel.h"
#include "core/solve/solve_record.h"
#include "solve/photographs/samples.h"
#include "solve/photographs/tile_reader.h"
#include "solver/sample_tiles.h"

namespace weft::solve {
namespace {

constexpr int kLookedAt = 64;     // pixels a side of a tile
constexpr float kLeastUp = 0.2F;  // of a normal; slopes of steeper ones are mostly noise
// Slopes that are all steeper by one factor have as much more curl, and as much more bend.
constexpr double kMostSteeper = 0.10, kSameShape = 0.01;

struct Squares {
  double curl = 0, bend = 0, corners = 0;
};

Squares squares_of(const SampleMaps& maps) {
  const auto is_known = [&](int x, int y) {
    return (maps.status(x, y) & kNoSolution) == 0 && maps.normal(x, y, 2) > kLeastUp;
  };
  const auto slope = [&](int x, int y, int axis) {
    return -static_cast<double>(maps.normal(x, y, axis)) / static_cast<double>(maps.normal(x, y, 2));
  };
  Squares squares;
  for (int y = 0; y + 1 < maps.status.height(); ++y) {
    for (int x = 0; x + 1 < maps.status.width(); ++x) {
      if (!is_known(x, y) || !is_known(x + 1, y) || !is_known(x, y + 1)) continue;
      // y is up, rows go down.
      const double px = slope(x + 1, y, 0) - slope(x, y, 0), py = slope(x, y, 0) - slope(x, y + 1, 0),
                   qx = slope(x + 1, y, 1) - slope(x, y, 1), qy = slope(x, y, 1) - slope(x, y + 1, 1);
      squares.curl += (py - qx) * (py - qx);
      squares.bend += px * px + py * py + qx * qx + qy * qy;
      ++squares.corners;
    }
  }
  return squares;
}

// The middles of those sample tiles that the better way solves.
std::vector<Rect> tiles_of(Size size, const solver::BlockChoice& choice) {
  std::vector<Rect> tiles;
  for (const Rect& tile : solver::sample_tiles(size)) {
    const int x = (tile.x0 + tile.x1) / 2, y = (tile.y0 + tile.y1) / 2;
    if (choice.weight_at(x, y) < 0.5F) continue;
    const int x0 = std::max(tile.x0, (x - kLookedAt / 2) / kRowGroup * kRowGroup),
              y0 = std::max(tile.y0, (y - kLookedAt / 2) / 2 * 2);
    tiles.push_back({x0, y0, std::min(x0 + kLookedAt, tile.x1), std::min(y0 + kLookedAt, tile.y1)});
  }
  return tiles;
}

Squares total(const Photographs& photographs, const std::vector<Rect>& tiles, const solver::Method& method,
              int threads) {
  std::vector<Squares> each(tiles.size());
  std::vector<TileReader> readers;
  for (int i = 0; i < resolved_threads(threads); ++i) {
    readers.emplace_back(photographs, TileOptions{.width = kLookedAt, .height = kLookedAt},
                         method.wants_rgb() ? ReadAs::kRgb : ReadAs::kTaken);
  }
  parallel_for(tiles.size(), threads, [&](std::size_t i, int worker) {
    each[i] = squares_of(solve_sample(readers[static_cast<std::size_t>(worker)].read(tiles[i]), method));
  });
  Squares all;
  for (const Squares& squares : each) {
    all.curl += squares.curl;
    all.bend += squares.bend;
    all.corners += squares.corners;
  }
  return all;
}

}  // namespace

bool CurlWitness::objects() const {
  if (!(base > 0) || !(better > (1 + kMostRise) * base)) return false;
  const double shape = better * bend_base / (base * bend_better);
  const bool is_steeper_alone = better <= (1 + kMostSteeper) * base && std::abs(shape - 1) <= kSameShape;
  return !is_steeper_alone;
}

CurlWitness ask_curl(const Photographs& photographs, const solver::Method& base, const solver::Method& better,
                     const solver::BlockChoice& choice, int threads) {
  const std::vector<Rect> tiles = tiles_of(photographs.size, choice);
  const Squares of_base = total(photographs, tiles, base, threads),
                of_better = total(photographs, tiles, better, threads);
  const auto rms = [](double sum, double count) { return count > 0 ? std::sqrt(sum / count) : 0; };
  return {rms(of_base.curl, of_base.corners), rms(of_better.curl, of_better.corners),
          rms(of_base.bend, of_base.corners), rms(of_better.bend, of_better.corners)};
}

std::string in_words(const CurlWitness& witness, const std::string& what) {
  return fmt::format(
      "left-out light is predicted better {}, but the normals are then less those of a surface: the curl of "
      "their slopes rises by {:.0f} percent; the level below is kept",
      what, 100 * (witness.better / witness.base - 1));
}

}  // namespace weft::solve
