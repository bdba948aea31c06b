// SPDX-License-Identifier: Apache-2.0
#include "solver/in_double/pixelwise.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace weft::solver {
namespace {

void count_pixel(const PixelSolution& s, SolveTally& tally) {
  switch (s.path) {
    case EquationsSolvedBy::kNothing:
      ++tally.unsolved;
      break;
    case EquationsSolvedBy::kNormalEquations:
      ++tally.by_normal_equations;
      break;
    case EquationsSolvedBy::kQr:
      ++tally.by_qr;
      break;
    case EquationsSolvedBy::kSvd:
      ++tally.by_svd;
      break;
  }
  tally.rejected_readings += s.rejected;
}

}  // namespace

float finite(double value) {
  return static_cast<float>(std::min(value, double{std::numeric_limits<float>::max()}));
}

void read_pixel(const TileInput& input, int x, int y, std::span<PixelRow> rows) {
  const auto planes = static_cast<std::size_t>(input.planes);
  const int px = input.tile.x0 + x, py = input.tile.y0 + y;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (std::size_t p = 0; p < planes; ++p) {
      const int channel = planes == 1 ? input.cfa.channel_at(px, py) : static_cast<int>(p);
      const LightField::Light light = input.field->at(k, channel, px, py);
      rows[k].direction = light.direction;
      rows[k].strength[p] = light.strength;
      rows[k].reading[p] = input.readings[k * planes + p](x, y);
    }
  }
}

void write_pixel(const PixelSolution& s, int planes, const TileOutput& output, int x, int y) {
  output.normal[0](x, y) = static_cast<float>(s.normal.x);
  output.normal[1](x, y) = static_cast<float>(s.normal.y);
  output.normal[2](x, y) = static_cast<float>(s.normal.z);
  for (std::size_t p = 0; p < static_cast<std::size_t>(planes); ++p) {
    output.albedo[p](x, y) = finite(s.albedo[p]);
    output.sigma_albedo[p](x, y) = finite(s.sigma_albedo[p]);
  }
  output.sigma_normal_deg(x, y) = static_cast<float>(s.sigma_normal_deg);
  output.residual(x, y) = finite(s.residual);
  output.status(x, y) = s.status;
  if (output.tally != nullptr) count_pixel(s, *output.tally);
}

void solve_each_pixel(const TileInput& input, const TileOutput& output,
                      const std::function<PixelSolution(std::span<const PixelRow>)>& solve) {
  std::vector<PixelRow> rows(input.field->count());
  for (int y = 0; y < input.tile.height(); ++y) {
    for (int x = 0; x < input.tile.width(); ++x) {
      read_pixel(input, x, y, rows);
      write_pixel(solve(rows), input.planes, output, x, y);
    }
  }
}

}  // namespace weft::solver
