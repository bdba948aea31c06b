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

// Pixels of sample tiles and where a solve left them.
struct GlossSamples {
  solver::LobeSamples samples;
  std::vector<Vec3> start;
};

GlossSamples samples_of_tile(const solver::TileInput& input, const SampleMaps& maps, int step,
                             solver::Sight sight) {
  GlossSamples all;
  all.samples.lights = input.field->count();
  solver::LobeReader reader(input, sight);
  std::vector<solver::LobeReading> readings(all.samples.lights);
  for (int y = 0; y < input.tile.height(); y += step) {
    for (int x = 0; x < input.tile.width(); x += step) {
      if (maps.status(x, y) & (kNoSolution | kDark)) continue;
      reader.read(x, y, readings);
      const auto used =
          std::ranges::count_if(readings, [](const solver::LobeReading& r) { return r.weight > 0; });
      if (used < 6) continue;
      all.samples.readings.insert(all.samples.readings.end(), readings.begin(), readings.end());
      const double albedo = maps.albedo(x, y);
      all.start.push_back(albedo * Vec3{maps.normal(x, y, 0), maps.normal(x, y, 1), maps.normal(x, y, 2)});
    }
  }
  return all;
}

// At most so many, evenly from all over.
GlossSamples thinned(const GlossSamples& all, std::size_t most) {
  const std::size_t pixels = all.samples.pixels();
  if (pixels <= most) return all;
  GlossSamples few;
  few.samples.lights = all.samples.lights;
  for (std::size_t i = 0; i < most; ++i) {
    // Neighbours in this order are far apart in the frame, so that the first of them stand for all.
    const std::size_t pixel = (i * 2654435761U) % pixels;
    const auto readings = all.samples.of(pixel);
    few.samples.readings.insert(few.samples.readings.end(), readings.begin(), readings.end());
    few.start.push_back(all.start[pixel]);
  }
  return few;
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
    parts[i] = samples_of_tile(input, solve_sample(input, base), step, sight);
  });
  GlossSamples all;
  all.samples.lights = photographs.count();
  for (const GlossSamples& part : parts) {
    all.samples.readings.insert(all.samples.readings.end(), part.samples.readings.begin(),
                                part.samples.readings.end());
    all.start.insert(all.start.end(), part.start.begin(), part.start.end());
  }
  const GlossSamples few = thinned(all, kGlossPixels);
  return solver::measure_lobe(few.samples, few.start, threads);
}

}  // namespace weft::pipeline
