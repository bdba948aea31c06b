// SPDX-License-Identifier: Apache-2.0
#include "core/rig/veil.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace weft {
namespace {

constexpr int kMostCells = 32;    // along a side
constexpr int kRowsInEvery = 16;  // two are read

// What each cell of a side gets of each: a Gaussian of their distance.
Image<double> spread_along(int cells, double sigma_cells) {
  Image<double> weights({cells, cells});
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      const double t = (i - j) / sigma_cells;
      weights(j, i) = std::exp(-t * t / 2);
    }
  }
  return weights;
}

// Sums of light and of pixels, after the same spread: their quotient is a mean that needs no edges.
struct Spread {
  double sum = 0, count = 0;
};

// The cell whose middle is the last at or before a place; -1 before the first.
int cell_before(int at, int side) {
  return (2 * at + 1 + side) / (2 * side) - 1;
}
double middle_of(int cell, int side) {
  return side * (cell + 0.5) - 0.5;
}

CoarseLight coarse_light(Size frame, const CfaPattern& cfa, const VeilOverFrame::ReadRows& read) {
  CoarseLight light(frame);
  Image<float> rows({frame.width, 2});
  for (int y = 0; y + 1 < frame.height; y += kRowsInEvery) {
    read({0, y, frame.width, y + 2}, rows.plane());
    for (int j = 0; j < 2; ++j) {
      for (int x = 0; x < frame.width; ++x) light.add(x, y + j, cfa.channel_at(x, y + j), rows(x, j));
    }
  }
  return light;
}

}  // namespace

CoarseLight::CoarseLight(Size frame)
    : CoarseLight(frame, std::max((std::max(frame.width, frame.height) + kMostCells - 1) / kMostCells,
                                  kRowsInEvery)) {}

CoarseLight::CoarseLight(Size frame, int side) : frame_(frame), side_(side) {
  const Size cells = {(frame.width + side_ - 1) / side_, (frame.height + side_ - 1) / side_};
  sum_ = Image<double>(cells, 3);
  count_ = Image<double>(cells, 3);
}

void CoarseLight::add(int x, int y, int channel, float light) {
  if (!std::isfinite(light)) return;
  sum_(x / side_, y / side_, channel) += static_cast<double>(light);
  ++count_(x / side_, y / side_, channel);
}

SpreadLight::SpreadLight(const CoarseLight& light, double spread) : side_(light.side()) {
  const Size cells = light.cells();
  Image<float> mean(cells, 3);
  const double sigma_cells = spread * std::hypot(light.frame().width, light.frame().height) / side_;
  const Image<double> across = spread_along(cells.width, sigma_cells);
  const Image<double> down = spread_along(cells.height, sigma_cells);
  std::vector<Spread> rows(static_cast<std::size_t>(cells.pixels()));
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < cells.height; ++y) {
      for (int x = 0; x < cells.width; ++x) {
        Spread& row = rows[static_cast<std::size_t>(y * cells.width + x)] = {};
        for (int j = 0; j < cells.width; ++j) {
          row.sum += across(j, x) * light.sum(j, y, c);
          row.count += across(j, x) * light.count(j, y, c);
        }
      }
    }
    for (int y = 0; y < cells.height; ++y) {
      for (int x = 0; x < cells.width; ++x) {
        Spread all;
        for (int j = 0; j < cells.height; ++j) {
          const Spread& row = rows[static_cast<std::size_t>(j * cells.width + x)];
          all.sum += down(j, y) * row.sum;
          all.count += down(j, y) * row.count;
        }
        mean(x, y, c) = all.count > 0 ? static_cast<float>(all.sum / all.count) : 0.0F;
      }
    }
  }
  mean_ = std::make_shared<const Image<float>>(std::move(mean));
}

SpreadLight::SpreadLight(int side, Image<float> cells)
    : side_(side), mean_(std::make_shared<const Image<float>>(std::move(cells))) {}

SpreadLight SpreadLight::part(Rect area) const {
  SpreadLight part = *this;
  part.x0_ += area.x0, part.y0_ += area.y0;
  return part;
}

// The mean of a column of cells at the height of row y.
double SpreadLight::cell_at(int column, int y, int channel) const {
  const int before = cell_before(y, side_);
  const int upper = std::max(before, 0), lower = std::min(before + 1, mean_->height() - 1);
  const double from = static_cast<double>((*mean_)(column, upper, channel));
  const double to = static_cast<double>((*mean_)(column, lower, channel));
  return from + (to - from) * (y - middle_of(before, side_)) / side_;
}

double SpreadLight::at(int x, int y, int channel) const {
  x += x0_, y += y0_;
  const int before = cell_before(x, side_);
  const double from = cell_at(std::max(before, 0), y, channel);
  const double to = cell_at(std::min(before + 1, mean_->width() - 1), y, channel);
  return from + (to - from) * (x - middle_of(before, side_)) / side_;
}

void SpreadLight::take_off(double share, Rect part, const CfaPattern& cfa, View<float> readings) const {
  part = {part.x0 + x0_, part.y0 + y0_, part.x1 + x0_, part.y1 + y0_};
  for (int y = part.y0; y < part.y1; ++y) {
    float* row = readings.row(y - part.y0) - part.x0;
    const int first = cell_before(part.x0, side_), last = cell_before(part.x1 - 1, side_);
    for (int cell = first; cell <= last; ++cell) {  // it runs straight from middle to middle
      const double middle = middle_of(cell, side_);
      const int x0 = std::max(part.x0, static_cast<int>(std::ceil(middle)));
      const int x1 = std::min(part.x1, static_cast<int>(std::ceil(middle + side_)));
      for (int x = x0; x < std::min(x0 + 2, x1); ++x) {  // by column of the filter pattern
        const int channel = cfa.channel_at(x, y);
        const double from = share * cell_at(std::max(cell, 0), y, channel);
        const double to = share * cell_at(std::min(cell + 1, mean_->width() - 1), y, channel);
        for (int i = x; i < x1; i += 2)
          row[i] -= static_cast<float>(from + (to - from) * (i - middle) / side_);
      }
    }
  }
}

VeilOverFrame::VeilOverFrame(const Veil& veil, Size frame, const CfaPattern& cfa, const ReadRows& read)
    : cfa_(cfa), share_(veil.share / (1 + veil.share)), light_(coarse_light(frame, cfa, read), veil.spread) {}

}  // namespace weft
