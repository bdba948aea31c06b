// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/glance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/rig/radiometry.h"

namespace weft::capture {
namespace {

constexpr int kMostColumns = 48, kMostRows = 36;

double light_on(const RawFrame& frame, Rect patch, const GlanceScale& scale) {
  std::array<double, 3> sum = {}, sites = {};
  for (int y = patch.y0; y < patch.y1; ++y) {
    for (int x = patch.x0; x < patch.x1; ++x) {
      const double black =
          static_cast<double>(frame.black[static_cast<std::size_t>(y & 1)][static_cast<std::size_t>(x & 1)]);
      const double v = (frame.counts(x, y) - black) / (static_cast<double>(frame.white) - black);
      if (frame.counts(x, y) >= saturated_from(frame, x, y)) return std::numeric_limits<double>::quiet_NaN();
      const auto c = static_cast<std::size_t>(frame.cfa.channel_at(x, y));
      const auto& [a, b] = scale.linearity[c];
      sum[c] += v * (1 + v * (a + b * v));
      ++sites[c];
    }
  }
  double light = 0;
  for (std::size_t c = 0; c < 3; ++c) light += scale.weight_rgb[c] * sum[c] / (3 * sites[c]);
  return light;
}

}  // namespace

PatchGrid PatchGrid::over(Size frame) {
  const auto along = [](int length, int most) { return std::clamp(length / 8, 1, most); };
  PatchGrid grid = {frame, along(frame.width, kMostColumns), along(frame.height, kMostRows), 2};
  grid.side = std::max(2, std::min(frame.width / grid.columns, frame.height / grid.rows) / 3 / 2 * 2);
  return grid;
}

Rect PatchGrid::patch(int i) const {
  const auto from = [&](int cell, int cells, int length) {
    return std::max(0, ((2 * cell + 1) * length / (2 * cells) - side / 2)) / 2 * 2;
  };
  const int x0 = from(i % columns, columns, frame.width), y0 = from(i / columns, rows, frame.height);
  return {x0, y0, x0 + side, y0 + side};
}

std::vector<double> glance_at(const RawFrame& frame, const PatchGrid& grid, const GlanceScale& scale) {
  std::vector<double> light;
  light.reserve(static_cast<std::size_t>(grid.count()));
  for (int i = 0; i < grid.count(); ++i) light.push_back(light_on(frame, grid.patch(i), scale));
  return light;
}

}  // namespace weft::capture
