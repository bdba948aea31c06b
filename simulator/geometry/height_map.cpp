// SPDX-License-Identifier: Apache-2.0
#include "simulator/geometry/height_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace weft::simulator {
namespace {

/// Weights of the four samples around a place, and their derivatives by it.
struct Weights {
  std::array<double, 4> value;
  std::array<double, 4> slope;
};

Weights weights_at(double t) {
  const double t2 = t * t, t3 = t2 * t;
  return {
      {(-t + 2 * t2 - t3) / 2, (2 - 5 * t2 + 3 * t3) / 2, (t + 4 * t2 - 3 * t3) / 2, (t3 - t2) / 2},
      {(-1 + 4 * t - 3 * t2) / 2, (-10 * t + 9 * t2) / 2, (1 + 8 * t - 9 * t2) / 2, (3 * t2 - 2 * t) / 2}};
}

// The sums of |weight|, largest half-way between samples: of values, and of the differences of neighbouring
// samples that make up a slope.
constexpr double kValueGain = 1.25;
constexpr double kSlopeGain = 1.5;

}  // namespace

HeightMap::HeightMap(std::shared_ptr<const Image<float>> heights, const PicturePlacement& placement)
    : heights_mm_(std::move(heights)), grid_(heights_mm_->size(), placement), range_{}, steepest_slope_(0) {
  const View<const float> h = heights_mm_->plane();
  double lowest = h(0, 0), highest = h(0, 0), step_x = 0, step_y = 0;
  for (int y = 0; y < h.height(); ++y) {
    for (int x = 0; x < h.width(); ++x) {
      const double here = h(x, y);
      lowest = std::min(lowest, here);
      highest = std::max(highest, here);
      step_x = std::max(step_x, std::abs(h(grid_.column(x + 1), y) - here));
      step_y = std::max(step_y, std::abs(h(x, grid_.row(y + 1)) - here));
    }
  }
  const double overshoot_mm = (kValueGain * kValueGain - 1) * (highest - lowest) / 2;
  range_ = {lowest - overshoot_mm, highest + overshoot_mm};
  steepest_slope_ = kSlopeGain * kValueGain * std::hypot(step_x, step_y) / placement.mm_per_sample;
}

SurfacePoint HeightMap::at(double x_mm, double y_mm) const {
  const View<const float> h = heights_mm_->plane();
  const PictureGrid::Place place = grid_.place_of(x_mm, y_mm);
  const double column = std::floor(place.column), row = std::floor(place.row);
  const Weights across = weights_at(place.column - column), down = weights_at(place.row - row);
  double height = 0, by_column = 0, by_row = 0;
  for (std::size_t j = 0; j < 4; ++j) {
    const float* line = h.row(grid_.row(row + static_cast<double>(j) - 1));
    double value = 0, slope = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double sample = line[grid_.column(column + static_cast<double>(i) - 1)];
      value += across.value[i] * sample;
      slope += across.slope[i] * sample;
    }
    height += down.value[j] * value;
    by_column += down.value[j] * slope;
    by_row += down.slope[j] * value;
  }
  const double c = grid_.cosine(), s = grid_.sine(), pitch_mm = grid_.placement().mm_per_sample;
  return {height,
          normal_of_slopes((c * by_column + s * by_row) / pitch_mm, (s * by_column - c * by_row) / pitch_mm)};
}

std::optional<Period> HeightMap::period_mm() const {
  const PicturePlacement& p = grid_.placement();
  if (!p.repeats || p.rotation_deg != 0) return std::nullopt;
  return Period{heights_mm_->width() * p.mm_per_sample, heights_mm_->height() * p.mm_per_sample};
}

}  // namespace weft::simulator
