// SPDX-License-Identifier: Apache-2.0
#include "material/smooth_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/parallel.h"

namespace weft::material {
namespace {

// Columns that are smoothed together, so that rows are read in whole cache lines.
constexpr int kColumnsAtOnce = 16;

// `reach` whole samples on both sides and the share `end` of the next one.
struct Box {
  int reach = 0;
  double end = 0;
};

// Three of them have the variance sigma^2 (Gwosdek et al. 2011, eq. 8).
Box box_of(double sigma) {
  constexpr double kPasses = 3;
  const double variance = sigma * sigma / kPasses;
  Box box;
  box.reach = static_cast<int>(std::floor(0.5 * std::sqrt(12 * variance + 1) - 0.5));
  const double r = box.reach, beyond = (r + 1) * (r + 1);
  box.end = (2 * r + 1) * (variance - r * (r + 1) / 3) / (2 * (beyond - variance));
  return box;
}

// One line of samples, and room for the next pass.
struct Line {
  std::vector<double> value, next;

  explicit Line(int samples)
      : value(static_cast<std::size_t>(samples)), next(static_cast<std::size_t>(samples)) {}

  void pass(Box box) {
    const auto n = static_cast<std::ptrdiff_t>(value.size()), reach = static_cast<std::ptrdiff_t>(box.reach);
    const auto at = [&](std::ptrdiff_t i) {
      return i >= 0 && i < n ? value[static_cast<std::size_t>(i)] : 0;
    };
    double whole = 0;
    for (std::ptrdiff_t i = 0; i <= std::min(reach, n - 1); ++i) whole += at(i);
    const double size = 2.0 * box.reach + 1 + 2 * box.end;
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      next[static_cast<std::size_t>(i)] = (whole + box.end * (at(i - reach - 1) + at(i + reach + 1))) / size;
      whole += at(i + reach + 1) - at(i - reach);
    }
    value.swap(next);
  }

  void smooth(Box box) {
    for (int i = 0; i < 3; ++i) pass(box);
  }
};

// What a line of ones becomes: the weight that lies within the border.
std::vector<double> weight_within(int samples, Box box) {
  Line ones(samples);
  std::ranges::fill(ones.value, 1.0);
  ones.smooth(box);
  return ones.value;
}

}  // namespace

void smooth(View<float> plane, double sigma_px, int threads) {
  if (!(sigma_px > 0)) return;
  const Box box = box_of(sigma_px);
  const int width = plane.width(), height = plane.height();
  const std::vector<double> across = weight_within(width, box), down = weight_within(height, box);
  parallel_for(static_cast<std::size_t>(height), threads, [&](std::size_t row, int) {
    float* const samples = plane.row(static_cast<int>(row));
    Line line(width);
    std::copy_n(samples, width, line.value.begin());
    line.smooth(box);
    for (std::size_t x = 0; x < line.value.size(); ++x)
      samples[x] = static_cast<float>(line.value[x] / across[x]);
  });
  const int groups = (width + kColumnsAtOnce - 1) / kColumnsAtOnce;
  parallel_for(static_cast<std::size_t>(groups), threads, [&](std::size_t group, int) {
    const int x0 = static_cast<int>(group) * kColumnsAtOnce, x1 = std::min(x0 + kColumnsAtOnce, width);
    std::vector<Line> lines(static_cast<std::size_t>(x1 - x0), Line(height));
    for (int y = 0; y < height; ++y) {
      for (int x = x0; x < x1; ++x)
        lines[static_cast<std::size_t>(x - x0)].value[static_cast<std::size_t>(y)] =
            static_cast<double>(plane(x, y));
    }
    for (Line& line : lines) line.smooth(box);
    for (int y = 0; y < height; ++y) {
      const auto i = static_cast<std::size_t>(y);
      for (int x = x0; x < x1; ++x)
        plane(x, y) = static_cast<float>(lines[static_cast<std::size_t>(x - x0)].value[i] / down[i]);
    }
  });
}

}  // namespace weft::material
