// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/lateral_colour.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulator/camera/optics.h"

namespace weft::simulator {
namespace {

constexpr int kTaps = 4;

/// Where one coordinate of a photosite looks: four neighbouring pixels and their weights.
struct Between {
  int first = 0;
  std::array<double, kTaps> weights = {};
};

Between between(double at) {
  const double below = std::floor(at), t = at - below, u = 1 - t;
  return {static_cast<int>(below) - 1,
          {-t * u * u / 2, 1 + t * t * (3 * t - 5) / 2, 1 + u * u * (3 * u - 5) / 2, -t * t * u / 2}};
}

std::size_t index_at(Rect rect, int x, int y) {
  return static_cast<std::size_t>(y - rect.y0) * static_cast<std::size_t>(rect.width()) +
         static_cast<std::size_t>(x - rect.x0);
}

}  // namespace

LateralColour::LateralColour(const ChromaticSettings& settings, const CameraModel& camera)
    : cx_(camera.cx),
      cy_(camera.cy),
      corner_px_(corner_distance_px(camera)),
      at_corner_px_{-settings.red_px, 0, -settings.blue_px},
      reach_(static_cast<int>(std::ceil(std::max(std::abs(settings.red_px), std::abs(settings.blue_px)))) +
             kTaps / 2) {}

double LateralColour::shift(std::size_t c, double from_axis_px) const {
  return at_corner_px_[c] * std::clamp(from_axis_px / corner_px_, -1.0, 1.0);
}

void LateralColour::image(std::span<const Rgb> in, Rect in_rect, Rect out_rect, std::span<Rgb> out) const {
  const auto width = static_cast<std::size_t>(in_rect.width());
  for (int y = out_rect.y0; y < out_rect.y1; ++y) {
    const auto from = in.begin() + static_cast<std::ptrdiff_t>(index_at(in_rect, out_rect.x0, y));
    std::copy_n(from, out_rect.width(),
                out.begin() + static_cast<std::ptrdiff_t>(index_at(out_rect, out_rect.x0, y)));
  }
  for (std::size_t c = 0; c < 3; ++c) {
    if (at_corner_px_[c] == 0) continue;
    std::vector<Between> columns;
    for (int x = out_rect.x0; x < out_rect.x1; ++x) columns.push_back(between(x + shift_x_px(c, x)));
    for (int y = out_rect.y0; y < out_rect.y1; ++y) {
      const Between row = between(y + shift_y_px(c, y));
      Rgb* to = &out[index_at(out_rect, out_rect.x0, y)];
      for (const Between& column : columns) {
        const Rgb* from = &in[index_at(in_rect, column.first, row.first)];
        double sum = 0, least = (*from)[c], most = least;
        for (std::size_t j = 0; j < kTaps; ++j, from += width) {
          for (std::size_t i = 0; i < kTaps; ++i) {
            const double light = from[i][c];
            sum += row.weights[j] * column.weights[i] * light;
            least = std::min(least, light);
            most = std::max(most, light);
          }
        }
        (*to++)[c] = std::clamp(sum, least, most);
      }
    }
  }
}

}  // namespace weft::simulator
