// SPDX-License-Identifier: Apache-2.0
#include "solve/photographs/plane_weights.h"

#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/statistics.h"
#include "core/solve/solve_record.h"
#include "solve/photographs/tile_reader.h"
#include "solver/in_double/pixel.h"
#include "solver/in_double/pixelwise.h"
#include "solver/sample_tiles.h"

namespace weft::solve {
namespace {

constexpr int kEvery = 7;  // columns and lines
constexpr std::size_t kFewest = 100;
constexpr double kLeastSigma = 1e-6;  // of the albedo: float has no better

}  // namespace

std::array<double, 3> measure_plane_weights(const Photographs& photographs) {
  if (photographs.planes().count == 1) return solver::kLuminance;
  std::array<std::vector<double>, 3> albedo, variance;
  solver::PixelSolver pixel_solver({3, true, std::nullopt, solver::Estimator::kRejecting});
  std::vector<solver::PixelRow> rows(photographs.count());
  TileReader reader(photographs, {.width = solver::kSampleTile, .height = solver::kSampleTile});
  for (const Rect& tile : solver::sample_tiles(photographs.size)) {
    const solver::TileInput input = reader.read(tile);
    for (int y = 0; y < tile.height(); y += kEvery) {
      for (int x = 0; x < tile.width(); x += kEvery) {
        solver::read_pixel(input, x, y, rows);
        const solver::PixelSolution pixel = pixel_solver.solve(rows);
        if (pixel.status & (kNoSolution | kZeroDof | kDark)) continue;
        // All channels have the same leverage: their sigmas are as their residuals.
        for (std::size_t c = 0; c < 3; ++c) {
          albedo[c].push_back(pixel.albedo[c]);
          variance[c].push_back(pixel.sigma_albedo[c] * pixel.sigma_albedo[c]);
        }
      }
    }
  }
  if (albedo[0].size() < kFewest) return solver::kLuminance;
  std::array<double, 3> weights = {};
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double a = median<double>(albedo[c]), v = median<double>(variance[c]);
    weights[c] = a > 0 ? a / (v + kLeastSigma * kLeastSigma * a * a) : 0;
    sum += weights[c];
  }
  if (!(sum > 0)) return solver::kLuminance;
  for (double& w : weights) w /= sum;
  return weights;
}

}  // namespace weft::solve
