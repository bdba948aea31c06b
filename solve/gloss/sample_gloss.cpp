// SPDX-License-Identifier: Apache-2.0
#include "solve/gloss/sample_gloss.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/base/parallel.h"
#include "core/solve/solve_record.h"
#include "solve/correction/corrected_tile.h"
#include "solve/correction/light_correction.h"
#include "solve/gloss/gloss.h"
#include "solve/photographs/samples.h"
#include "solve/photographs/tile_reader.h"
#include "solver/reflectance/lobe_readings.h"
#include "solver/reflectance/measured_lobe.h"
#include "solver/sample_tiles.h"

namespace weft::solve {
namespace {

// A prime: pixel i times it meets every pixel once.
constexpr std::size_t kFarApart = 2654435761U;

// The rows of a tile that pixels are taken of.
std::vector<Rect> taken_rows(Rect tile, int step) {
  std::vector<Rect> rows;
  for (int y = tile.y0; y < tile.y1; y += step) rows.push_back({tile.x0, y, tile.x1, y + 1});
  return rows;
}

// Takes pixels of one sample tile after another; one a worker.
class Sampler {
 public:
  Sampler(const Photographs& photographs, const solver::Method& base, const LightCorrection* correction,
          int step)
      : reader_(photographs, {.width = solver::kSampleTile, .height = 1}),
        base_(base),
        correction_(correction),
        step_(step),
        frame_(photographs.size),
        sight_(sight_of(photographs)) {}

  void take(Rect tile, GlossSamples& samples) {
    for (const Rect& row : taken_rows(tile, step_)) take_row(row, samples);
  }

 private:
  void take_row(Rect row, GlossSamples& samples) {
    solver::TileInput input = reader_.read(row);
    // Light from the cloth itself is taken off, and shadows are marked.
    if (correction_ != nullptr) corrected_.apply(*correction_, input);
    const SampleMaps maps = solve_sample(input, base_);
    solver::LobeReader reader(input, sight_);
    std::vector<solver::LobeReading> readings(reader.count()), of_plane(reader.count());
    for (int x = 0; x < row.width(); x += step_) {
      if (maps.status(x, 0) & (kNoSolution | kDark)) continue;
      reader.read(x, 0, readings);
      if (solver::used_of(readings) < solver::kLeastLobeReadings) continue;
      samples.readings.insert(samples.readings.end(), readings.begin(), readings.end());
      for (std::size_t p = 0; p < samples.planes.size() && input.planes == 3; ++p) {
        reader.read_plane(x, 0, static_cast<int>(p), readings, of_plane);
        samples.planes[p].insert(samples.planes[p].end(), of_plane.begin(), of_plane.end());
      }
      samples.start.push_back(static_cast<double>(maps.albedo(x, 0)) *
                              Vec3{maps.normal(x, 0, 0), maps.normal(x, 0, 1), maps.normal(x, 0, 2)});
      samples.part.push_back(part_of(row.x0 + x, row.y0));
    }
  }

  std::size_t part_of(int x, int y) const {
    return (2 * y < frame_.height ? 0U : 2U) + (2 * x < frame_.width ? 0U : 1U);
  }

  TileReader reader_;
  const solver::Method& base_;
  const LightCorrection* correction_;
  int step_;
  Size frame_;
  solver::Sight sight_;
  CorrectedTile corrected_;
};

void append(const GlossSamples& from, std::size_t pixel, GlossSamples& to) {
  const std::span<const solver::LobeReading> readings = from.of(pixel);
  to.readings.insert(to.readings.end(), readings.begin(), readings.end());
  for (std::size_t p = 0; p < to.planes.size() && !from.planes[p].empty(); ++p) {
    const std::span<const solver::LobeReading> of_plane = from.of_plane(p, pixel);
    to.planes[p].insert(to.planes[p].end(), of_plane.begin(), of_plane.end());
  }
  to.start.push_back(from.start[pixel]);
  to.part.push_back(from.part[pixel]);
}

}  // namespace

Result<GlossSamples> sample_gloss(const Photographs& photographs, const solver::Method& base,
                                  LightCorrection* correction, int threads) {
  const std::vector<Rect> tiles = solver::sample_tiles(photographs.size);
  const int step = solver::sample_step(tiles, 4 * kGlossPixels);
  std::vector<Sampler> samplers;
  for (int i = 0; i < resolved_threads(threads); ++i)
    samplers.emplace_back(photographs, base, correction, step);
  std::vector<GlossSamples> by_tile(tiles.size());
  // A correction is traced for one row of tiles after another.
  for (std::size_t begin = 0, end = 0; begin < tiles.size(); begin = end) {
    while (end < tiles.size() && tiles[end].y0 == tiles[begin].y0) ++end;
    if (correction != nullptr) {
      const Rect rows = {0, tiles[begin].y0, photographs.size.width, tiles[begin].y1};
      std::vector<Rect> taken;
      for (std::size_t i = begin; i < end; ++i)
        std::ranges::copy(taken_rows(tiles[i], step), std::back_inserter(taken));
      if (Result<void> ok = correction->prepare_only(rows, taken); !ok) return std::move(ok).error();
    }
    parallel_for(end - begin, threads, [&](std::size_t i, int worker) {
      samplers[static_cast<std::size_t>(worker)].take(tiles[begin + i], by_tile[begin + i]);
    });
  }
  GlossSamples all;
  for (const GlossSamples& tile : by_tile) {
    for (std::size_t i = 0; i < tile.pixels(); ++i) append(tile, i, all);
  }
  GlossSamples chosen;
  chosen.leds = photographs.leds;
  chosen.states = photographs.parallel ? 2 : 1;
  for (std::size_t i = 0; i < std::min(all.pixels(), kGlossPixels); ++i)
    append(all, i * kFarApart % all.pixels(), chosen);
  return chosen;
}

GlossSamples by_leds(const GlossSamples& samples, std::span<const int> leds) {
  GlossSamples chosen = {.leds = {leds.begin(), leds.end()},
                         .states = samples.states,
                         .readings = {},
                         .planes = {},
                         .start = samples.start,
                         .part = samples.part};
  const auto add = [&](std::span<const solver::LobeReading> all, std::vector<solver::LobeReading>& into) {
    for (std::size_t state = 0; state < samples.states; ++state) {
      const auto of_state = all.subspan(state * samples.leds.size(), samples.leds.size());
      for (const int led : leds) {
        const auto found = std::ranges::find(samples.leds, led) - samples.leds.begin();
        const bool is_there = found < static_cast<std::ptrdiff_t>(of_state.size());
        into.push_back(of_state[is_there ? static_cast<std::size_t>(found) : 0]);
        if (!is_there) into.back().weight = 0;
      }
    }
  };
  for (std::size_t i = 0; i < samples.pixels(); ++i) {
    add(samples.of(i), chosen.readings);
    for (std::size_t p = 0; p < chosen.planes.size() && !samples.planes[p].empty(); ++p)
      add(samples.of_plane(p, i), chosen.planes[p]);
  }
  return chosen;
}

}  // namespace weft::solve
