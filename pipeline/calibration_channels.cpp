// SPDX-License-Identifier: Apache-2.0
#include "pipeline/calibration_channels.h"

#include <algorithm>
#include <vector>

#include "core/parallel.h"

namespace weft::app {
namespace {

// 0, 16, 32 ... and the last of `count`.
std::vector<int> places(int count) {
  std::vector<int> at;
  for (int i = 0; i < count - 1; i += kCalibrationSigmaStep) at.push_back(i);
  at.push_back(count - 1);
  return at;
}

}  // namespace

void fill_calibration_sigma(const solver::CalibrationSigmas& sigmas, Rect band,
                            const std::array<View<const float>, 3>& normal, View<const float> albedo,
                            const CfaPattern* cfa, int threads, View<float> normal_deg,
                            View<float> relative_albedo) {
  const std::vector<int> columns = places(band.width()), rows = places(band.height());
  std::vector<std::vector<solver::CalibrationSigma>> grid(rows.size());
  parallel_for(rows.size(), threads, [&](std::size_t j, int) {
    const int y = rows[j];
    for (const int x : columns) {
      const Vec3 n = {normal[0](x, y), normal[1](x, y), normal[2](x, y)};
      const int c = cfa != nullptr ? cfa->channel_at(band.x0 + x, band.y0 + y) : 1;
      grid[j].push_back(sigmas.at(band.x0 + x, band.y0 + y, c, n, static_cast<double>(albedo(x, y))));
    }
  });
  parallel_for(static_cast<std::size_t>(band.height()), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    const std::size_t j = std::min(row / kCalibrationSigmaStep, rows.size() - 1),
                      below = std::min(j + 1, rows.size() - 1);
    const double t = below == j ? 0 : static_cast<double>(y - rows[j]) / (rows[below] - rows[j]);
    for (int x = 0; x < band.width(); ++x) {
      const std::size_t i = std::min(static_cast<std::size_t>(x) / kCalibrationSigmaStep, columns.size() - 1);
      const std::size_t right = std::min(i + 1, columns.size() - 1);
      const double s = right == i ? 0 : static_cast<double>(x - columns[i]) / (columns[right] - columns[i]);
      const auto blend = [&](double solver::CalibrationSigma::*value) {
        const double above = (1 - s) * grid[j][i].*value + s * grid[j][right].*value;
        return static_cast<float>((1 - t) * above +
                                  t * ((1 - s) * grid[below][i].*value + s * grid[below][right].*value));
      };
      normal_deg(x, y) = blend(&solver::CalibrationSigma::normal_deg);
      relative_albedo(x, y) = blend(&solver::CalibrationSigma::relative_albedo);
    }
  });
}

}  // namespace weft::app
