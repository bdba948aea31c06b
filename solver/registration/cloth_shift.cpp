// SPDX-License-Identifier: Apache-2.0
#include "solver/registration/cloth_shift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/vec.h"

namespace weft::solver {
namespace {

constexpr int kLobes = 3;

struct Taps {
  int first = 0, count = 0;  // pixels from the site, every `step`
  std::array<float, 2 * kLobes> weight = {};
};

double sinc(double x) {
  return x == 0 ? 1 : std::sin(kPi * x) / (kPi * x);
}

// What a site takes from its row or column for a displacement in pixels.
Taps taps_for(double displacement, int step) {
  const double steps = displacement / step, whole = std::floor(steps), fraction = steps - whole;
  if (fraction == 0) return {static_cast<int>(whole) * step, 1, {1}};
  Taps t = {(static_cast<int>(whole) - kLobes + 1) * step, 2 * kLobes, {}};
  std::array<double, 2 * kLobes> w = {};
  double sum = 0;
  for (int i = 0; i < t.count; ++i) {
    const double x = i - kLobes + 1 - fraction;
    sum += w[static_cast<std::size_t>(i)] = sinc(x) * sinc(x / kLobes);
  }
  for (std::size_t i = 0; i < w.size(); ++i) t.weight[i] = static_cast<float>(w[i] / sum);
  return t;
}

ClothShift::Displacement displacement_at(const ClothShift& shift, double x, double y, Size frame) {
  return shift.at(x - (frame.width - 1) / 2.0, y - (frame.height - 1) / 2.0);
}

}  // namespace

Rect seen_through(const ClothShift& shift, Rect tile, Size frame, int step) {
  double left = 0, right = 0, up = 0, down = 0;
  for (const int x : {tile.x0 - kRowGroup, tile.x1 + kRowGroup}) {
    for (const int y : {tile.y0, tile.y1}) {
      const ClothShift::Displacement d = displacement_at(shift, x, y, frame);
      left = std::min(left, d.x);
      right = std::max(right, d.x);
      up = std::min(up, d.y);
      down = std::max(down, d.y);
    }
  }
  const auto pixels = [&](double d) { return static_cast<int>(std::ceil(d)) + kLobes * step; };
  const Rect around = {tile.x0 - pixels(-left), tile.y0 - pixels(-up), tile.x1 + pixels(right),
                       tile.y1 + pixels(down)};
  return {std::max(around.x0, 0) & ~1, std::max(around.y0, 0) & ~1, std::min(around.x1, frame.width),
          std::min(around.y1, frame.height)};
}

void resample(View<const float> source, Rect source_rect, const ClothShift& shift, Rect tile, Size frame,
              int step, View<float> out) {
  std::vector<float> line;
  for (int y = tile.y0; y < tile.y1; ++y) {
    float* row = out.row(y - tile.y0);
    for (int x0 = tile.x0, x1 = 0; x0 < tile.x1; x0 = x1) {
      const int run = x0 / kRowGroup * kRowGroup;
      x1 = std::min(run + kRowGroup, tile.x1);
      const ClothShift::Displacement d = displacement_at(shift, run + (kRowGroup - 1) / 2.0, y, frame);
      const Taps across = taps_for(d.x, step), down = taps_for(d.y, step);
      std::fill(row + x0 - tile.x0, row + x1 - tile.x0, std::numeric_limits<float>::quiet_NaN());
      if (y + down.first < 0 || y + down.first + (down.count - 1) * step >= frame.height) continue;
      const int begin = std::max(x0, -across.first);
      const int end = std::min(x1, frame.width - across.first - (across.count - 1) * step);
      if (begin >= end) continue;

      const int width = end - begin + (across.count - 1) * step;
      const int from_x = begin + across.first - source_rect.x0;
      line.assign(static_cast<std::size_t>(width), 0);
      for (int i = 0; i < down.count; ++i) {
        const float* from = source.row(y + down.first + i * step - source_rect.y0) + from_x;
        const float w = down.weight[static_cast<std::size_t>(i)];
        for (int x = 0; x < width; ++x) line[static_cast<std::size_t>(x)] += w * from[x];
      }
      for (int x = 0; x < end - begin; ++x) {
        float sum = 0;
        for (int i = 0; i < across.count; ++i) {
          sum += across.weight[static_cast<std::size_t>(i)] * line[static_cast<std::size_t>(x + i * step)];
        }
        row[begin + x - tile.x0] = std::isfinite(sum) ? sum : std::numeric_limits<float>::infinity();
      }
    }
  }
}

}  // namespace weft::solver
