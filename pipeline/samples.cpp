// SPDX-License-Identifier: Apache-2.0
#include "pipeline/samples.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/parallel.h"
#include "pipeline/tile_reader.h"
#include "solver/in_double/pixel.h"
#include "solver/kernels/demosaic.h"
#include "solver/sample_tiles.h"

namespace weft::app {
namespace {

// Counts readings that can be used, and those that are dark against the bright ones of their pixel.
void count_shadowed(const solver::TileInput& input, SampleMaps& maps) {
  const std::size_t lights = input.field->count();
  const auto planes = static_cast<std::size_t>(input.planes);
  std::vector<double> x;
  for (int row = 0; row < input.tile.height(); ++row) {
    for (int column = 0; column < input.tile.width(); ++column) {
      x.clear();
      const int px = input.tile.x0 + column, py = input.tile.y0 + row;
      const int channel = planes == 1 ? input.cfa.channel_at(px, py) : 1;
      const std::size_t plane = planes == 1 ? 0 : 1;
      for (std::size_t k = 0; k < lights; ++k) {
        const double r = input.readings[k * planes + plane](column, row);
        if (std::isfinite(r)) x.push_back(r / input.field->at(k, channel, px, py).strength);
      }
      const auto rank = static_cast<std::size_t>(solver::bright_rank(lights));
      if (x.size() < rank) continue;
      std::nth_element(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(rank) - 1, x.end(),
                       std::greater<>());
      const double threshold = solver::kShadowShare * x[rank - 1];
      maps.readings += static_cast<std::int64_t>(x.size());
      maps.shadowed += std::count_if(x.begin(), x.end(), [&](double v) { return v < threshold; });
    }
  }
}

SampleMaps solve_sample(const Photographs& photographs, const solver::Method& method, TileReader& reader,
                        Rect tile) {
  const Size size = {tile.width(), tile.height()};
  const bool mosaics = photographs.rgb.empty();
  const int planes = mosaics && !method.wants_rgb() ? 1 : 3;
  SampleMaps maps{tile,
                  Image<float>(size, 3),
                  Image<float>(size),
                  Image<float>(size),
                  Image<float>(size),
                  Image<std::uint16_t>(size)};
  Image<float> albedo(size, 3), sigma_albedo(size, 3);
  const std::vector<View<const float>>& readings = reader.read(tile);
  const solver::TileInput input = {tile,
                                   planes,
                                   mosaics ? photographs.radiometry->cfa() : CfaPattern{},
                                   readings,
                                   &*photographs.field,
                                   planes == 1 ? photographs.noise : std::nullopt};
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
  const View<const float> shown = albedo.plane(planes == 1 ? 0 : 1);
  for (int y = 0; y < size.height; ++y) std::copy_n(shown.row(y), size.width, maps.albedo.plane().row(y));
  count_shadowed(input, maps);
  return maps;
}

}  // namespace

solver::SolvedSample SampleMaps::sample() const {
  return {{normal.plane(0), normal.plane(1), normal.plane(2)},
          albedo.plane(),
          status.plane(),
          readings,
          shadowed};
}

std::vector<SampleMaps> solve_samples(const Photographs& photographs, const solver::Method& method,
                                      int threads) {
  const std::vector<Rect> tiles = solver::sample_tiles(photographs.size);
  std::vector<SampleMaps> solved(tiles.size());
  const bool to_rgb = photographs.rgb.empty() && method.wants_rgb();
  std::vector<TileReader> readers;
  for (int i = 0; i < resolved_threads(threads); ++i) {
    readers.emplace_back(photographs,
                         TileOptions{.width = solver::kSampleTile, .height = solver::kSampleTile},
                         to_rgb ? solver::kDemosaicReach : 0, to_rgb);
  }
  parallel_for(tiles.size(), threads, [&](std::size_t i, int worker) {
    solved[i] = solve_sample(photographs, method, readers[static_cast<std::size_t>(worker)], tiles[i]);
  });
  return solved;
}

Result<solver::Gates> measure_gates(const std::vector<SampleMaps>& samples) {
  std::vector<solver::SolvedSample> all;
  for (const SampleMaps& maps : samples) all.push_back(maps.sample());
  return solver::measure_gates(all, {});
}

Json json_of(const solver::Gates& gates) {
  Json all = Json::array();
  for (const solver::Gate& gate : gates.measured) {
    all.push_back({{"name", gate.name},
                   {"value", gate.value},
                   {"limit", gate.limit},
                   {"unit", gate.unit},
                   {"verdict", gate.is_over ? "over" : "under"}});
  }
  return all;
}

}  // namespace weft::app
