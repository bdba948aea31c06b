// SPDX-License-Identifier: Apache-2.0
#include "pipeline/gloss.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/solve_record.h"
#include "pipeline/samples.h"
#include "pipeline/tile_reader.h"
#include "solver/sample_tiles.h"

namespace weft::pipeline {
namespace {

// Fewer readings say little of a lobe once normal and albedo are taken from them.
constexpr int kLeastReadings = 6;
// A prime: pixel i times it meets every pixel once.
constexpr std::size_t kFarApart = 2654435761U;

// Pixels of sample tiles and where a solve left them.
struct GlossSamples {
  std::vector<solver::LobeReading> readings;  // [pixel * lights + light]
  std::vector<Vec3> start;
};

void add_tile(const solver::TileInput& input, const SampleMaps& maps, int step, solver::Sight sight,
              GlossSamples& samples) {
  solver::LobeReader reader(input, sight);
  std::vector<solver::LobeReading> readings(input.field->count());
  for (int y = 0; y < input.tile.height(); y += step) {
    for (int x = 0; x < input.tile.width(); x += step) {
      if (maps.status(x, y) & (kNoSolution | kDark)) continue;
      reader.read(x, y, readings);
      if (solver::used_of(readings) < kLeastReadings) continue;
      samples.readings.insert(samples.readings.end(), readings.begin(), readings.end());
      samples.start.push_back(static_cast<double>(maps.albedo(x, y)) *
                              Vec3{maps.normal(x, y, 0), maps.normal(x, y, 1), maps.normal(x, y, 2)});
    }
  }
}

}  // namespace

solver::Sight sight_of(const Photographs& photographs) {
  std::optional<Vec3> centre;
  if (photographs.camera) {
    const CameraModel& camera = *photographs.camera;
    const Mat3& r = camera.camera_from_rig_rotation;
    const Vec3& t = camera.camera_from_rig_translation_mm;
    centre = Vec3{-(r[0][0] * t.x + r[1][0] * t.y + r[2][0] * t.z),
                  -(r[0][1] * t.x + r[1][1] * t.y + r[2][1] * t.z),
                  -(r[0][2] * t.x + r[1][2] * t.y + r[2][2] * t.z)};
  }
  return solver::Sight(centre, photographs.field->cloth_height_mm());
}

solver::MeasuredLobe measure_gloss(const Photographs& photographs, const solver::Method& base, int threads) {
  const std::vector<Rect> tiles = solver::sample_tiles(photographs.size);
  const int step = solver::sample_step(tiles, 4 * kGlossPixels);
  const solver::Sight sight = sight_of(photographs);
  std::vector<GlossSamples> parts(tiles.size());
  std::vector<TileReader> readers;
  for (int i = 0; i < resolved_threads(threads); ++i) {
    readers.emplace_back(photographs,
                         TileOptions{.width = solver::kSampleTile, .height = solver::kSampleTile});
  }
  parallel_for(tiles.size(), threads, [&](std::size_t i, int worker) {
    const solver::TileInput input = readers[static_cast<std::size_t>(worker)].read(tiles[i]);
    add_tile(input, solve_sample(input, base), step, sight, parts[i]);
  });
  GlossSamples all;
  for (const GlossSamples& part : parts) {
    all.readings.insert(all.readings.end(), part.readings.begin(), part.readings.end());
    all.start.insert(all.start.end(), part.start.begin(), part.start.end());
  }
  // Pixels that follow each other are far apart in the frame, so that the first of them stand for all.
  solver::LobeSamples samples(photographs.count());
  std::vector<Vec3> start;
  const std::size_t pixels = all.start.size();
  for (std::size_t i = 0; i < std::min(pixels, kGlossPixels); ++i) {
    const std::size_t pixel = i * kFarApart % pixels;
    samples.add({all.readings.data() + pixel * photographs.count(), photographs.count()});
    start.push_back(all.start[pixel]);
  }
  return solver::measure_lobe(samples, start, threads);
}

}  // namespace weft::pipeline
