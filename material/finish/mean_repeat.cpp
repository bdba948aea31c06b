// SPDX-License-Identifier: Apache-2.0
#include "material/finish/mean_repeat.h"

#include <algorithm>
#include <cmath>

namespace weft::material {
namespace {

std::size_t place_in(int i, double repeat, int places) {
  const double phase = i / repeat - std::floor(i / repeat);
  return static_cast<std::size_t>(std::min(static_cast<int>(phase * places), places - 1));
}

}  // namespace

MeanRepeat::MeanRepeat(double repeat_x, double repeat_y)
    : repeat_x_(repeat_x),
      repeat_y_(repeat_y),
      columns_(std::max(1, static_cast<int>(std::ceil(repeat_x)))),
      rows_(std::max(1, static_cast<int>(std::ceil(repeat_y)))),
      count_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)),
      sum_(count_.size()) {}

void MeanRepeat::add(View<const float> plane) {
  std::vector<std::size_t> columns;
  for (int x = 0; x < plane.width(); ++x) columns.push_back(column(x));
  for (int y = 0; y < plane.height(); ++y) {
    const std::size_t first = row(y);
    for (int x = 0; x < plane.width(); ++x) {
      const std::size_t i = first + columns[static_cast<std::size_t>(x)];
      count_[i] += 1;
      sum_[i] += static_cast<double>(plane(x, y));
    }
  }
}

double MeanRepeat::at(int x, int y) const {
  const std::size_t i = row(y) + column(x);
  return count_[i] > 0 ? sum_[i] / count_[i] : 0;
}

std::size_t MeanRepeat::column(int x) const {
  return place_in(x, repeat_x_, columns_);
}

std::size_t MeanRepeat::row(int y) const {
  return place_in(y, repeat_y_, rows_) * static_cast<std::size_t>(columns_);
}

}  // namespace weft::material
