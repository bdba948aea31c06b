// SPDX-License-Identifier: Apache-2.0
#include "solve/files/condition_map.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/parallel.h"
#include "core/image/tiles.h"
#include "core/image_io/image_io.h"
#include "solve/files/map_files.h"
#include "solve/photographs/tile_reader.h"
#include "solver/in_double/factor.h"
#include "solver/in_double/pixelwise.h"

namespace weft::solve {
namespace {

/// What one thread works with.
struct Worker {
  TileReader reader;
  std::vector<solver::PixelRow> rows;
  std::vector<solver::ReadingStory> stories;
};

}  // namespace

double condition_decades(std::span<const solver::PixelRow> rows,
                         std::span<const solver::ReadingStory> stories) {
  std::vector<solver::WeightedDirection> kept;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Vec3& l = rows[k].direction;
    if (stories[k].use == solver::ReadingUse::kUsed) kept.push_back({{l.x, l.y, l.z}});
  }
  return std::min(std::log10(solver::factorise(kept).condition), kMostDecades);
}

Result<void> write_condition_map(const Photographs& photographs, const std::string& method,
                                 const std::filesystem::path& file, Compression compression,
                                 const JobContext& context) {
  const Size size = photographs.size;
  const TileOptions tile = {.threads = context.threads};
  Image<float> decades(size);
  std::vector<Worker> workers;
  for (int i = 0; i < resolved_threads(context.threads); ++i)
    workers.push_back({TileReader(photographs, tile), {}, {}});
  std::atomic<std::int64_t> done = 0;
  const auto look = [&](Rect part, int number) {
    Worker& worker = workers[static_cast<std::size_t>(number)];
    const solver::TileInput input = worker.reader.read(part);
    solver::PixelOptions options = solver::pixel_options_of(method);
    options.planes = input.planes;
    options.noise = input.noise;
    options.plane_weights = input.plane_weights;
    solver::PixelSolver pixel(options);
    worker.rows.resize(input.field->count());
    worker.stories.resize(worker.rows.size());
    for (int y = part.y0; y < part.y1; ++y) {
      for (int x = part.x0; x < part.x1; ++x) {
        solver::read_pixel(input, x - part.x0, y - part.y0, worker.rows);
        pixel.explain(worker.rows, worker.stories);
        decades(x, y) = static_cast<float>(condition_decades(worker.rows, worker.stories));
      }
    }
    const std::int64_t pixels = done += std::int64_t{part.width()} * part.height();
    if (number == 0)
      context.progress("condition", static_cast<double>(pixels) / static_cast<double>(size.pixels()));
  };
  if (Result<void> ok = for_each_tile({0, 0, size.width, size.height}, tile, context.stop, look); !ok)
    return ok;
  const std::array<View<const float>, 1> plane = {decades.plane()};
  return write_image(
      file, plane, {"condition"},
      {.type = SampleType::kHalf, .compression = compression, .pitch_mm = pitch_in_the_middle(photographs)});
}

}  // namespace weft::solve
