// SPDX-License-Identifier: Apache-2.0
#include "solve/photographs/samples.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "solve/photographs/diagnosis_pixels.h"
#include "solve/photographs/picture_axes.h"
#include "solve/photographs/tile_reader.h"
#include "solver/diagnosis/highlights.h"
#include "solver/in_double/pixel.h"
#include "solver/sample_tiles.h"

namespace weft::solve {
namespace {

// Counts readings that can be used, and those that are dark against the bright ones of their pixel.
void count_shadowed(const solver::TileInput& input, SampleMaps& maps) {
  const std::size_t lights = input.field->count();
  const Planes planes = {input.planes, input.cfa};
  std::vector<double> x;
  for (int row = 0; row < input.tile.height(); ++row) {
    for (int column = 0; column < input.tile.width(); ++column) {
      x.clear();
      const int px = input.tile.x0 + column, py = input.tile.y0 + row;
      const int channel = planes.channel_at(planes.speaker(), px, py);
      for (std::size_t k = 0; k < lights; ++k) {
        const int plane = static_cast<int>(k) * planes.count + planes.speaker();
        const double r = input.readings[static_cast<std::size_t>(plane)](column, row);
        if (std::isfinite(r)) x.push_back(r / input.field->at(k, channel, px, py).strength);
      }
      const auto rank = static_cast<std::size_t>(solver::bright_rank(lights));
      if (x.size() < rank) continue;
      const double threshold = solver::kShadowShare * value_of_rank<double>(x, x.size() - rank);
      maps.readings += static_cast<std::int64_t>(x.size());
      maps.shadowed += std::count_if(x.begin(), x.end(), [&](double v) { return v < threshold; });
    }
  }
}

}  // namespace

solver::SolvedSample SampleMaps::sample() const {
  return {{normal.plane(0), normal.plane(1), normal.plane(2)},
          albedo.plane(),
          status.plane(),
          readings,
          shadowed};
}

SampleMaps solve_sample(const solver::TileInput& input, const solver::Method& method) {
  const Size size = {input.tile.width(), input.tile.height()};
  SampleMaps maps{input.tile,         Image<float>(size, 3), Image<float>(size),
                  Image<float>(size), Image<float>(size),    Image<std::uint16_t>(size)};
  Image<float> albedo(size, 3), sigma_albedo(size, 3);
  solver::TileOutput output;
  for (int i = 0; i < 3; ++i) {
    const auto c = static_cast<std::size_t>(i);
    output.normal[c] = maps.normal.plane(i);
    output.albedo[c] = albedo.plane(i);
    output.sigma_albedo[c] = sigma_albedo.plane(i);
  }
  output.sigma_normal_deg = maps.sigma_normal_deg.plane();
  output.residual = maps.residual.plane();
  output.status = maps.status.plane();
  method.solve(input, output);
  const View<const float> shown = albedo.plane(Planes{input.planes, input.cfa}.speaker());
  for (int y = 0; y < size.height; ++y) std::copy_n(shown.row(y), size.width, maps.albedo.plane().row(y));
  return maps;
}

std::vector<SampleMaps> solve_samples(const Photographs& photographs, const solver::Method& method,
                                      int threads) {
  const std::vector<Rect> tiles = solver::sample_tiles(photographs.size);
  std::vector<SampleMaps> solved(tiles.size());
  std::vector<TileReader> readers;
  for (int i = 0; i < resolved_threads(threads); ++i) {
    readers.emplace_back(photographs,
                         TileOptions{.width = solver::kSampleTile, .height = solver::kSampleTile},
                         method.wants_rgb() ? ReadAs::kRgb : ReadAs::kTaken);
  }
  parallel_for(tiles.size(), threads, [&](std::size_t i, int worker) {
    const solver::TileInput input = readers[static_cast<std::size_t>(worker)].read(tiles[i]);
    solved[i] = solve_sample(input, method);
    count_shadowed(input, solved[i]);
  });
  return solved;
}

Result<solver::Gates> measure_gates(const std::vector<SampleMaps>& samples, const Photographs& photographs) {
  const Mat3 axes = picture_from_rig(photographs.camera);
  std::vector<Image<float>> turned;
  std::vector<solver::SolvedSample> all;
  for (const SampleMaps& maps : samples) {
    Image<float>& normal = turned.emplace_back(maps.normal.size(), 3);
    for (int y = 0; y < normal.height(); ++y) {
      for (int x = 0; x < normal.width(); ++x) {
        const Vec3 n = axes * Vec3{maps.normal(x, y, 0), maps.normal(x, y, 1), maps.normal(x, y, 2)};
        normal(x, y, 0) = static_cast<float>(n.x);
        normal(x, y, 1) = static_cast<float>(n.y);
        normal(x, y, 2) = static_cast<float>(n.z);
      }
    }
    all.push_back(maps.sample());
    all.back().normal = {normal.plane(0), normal.plane(1), normal.plane(2)};
  }
  solver::GateLimits limits;
  if (solver::outshining_share(read_evidence(photographs)) < solver::kLeastOutshining) {
    limits.specular_share = 1;
  }
  return solver::measure_gates(all, limits, photographs.albedo_scale);
}

}  // namespace weft::solve
