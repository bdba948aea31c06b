// SPDX-License-Identifier: Apache-2.0
#include "material/finish/mean_repeat.h"

#include <algorithm>
#include <cmath>

#include "core/solve_record.h"

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

void MeanRepeat::add(int x, int y, double value) {
  const std::size_t i = row(y) + column(x);
  count_[i] += 1;
  sum_[i] += value;
}

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

double MeanRepeat::squares() const {
  double all = 0;
  for (std::size_t i = 0; i < sum_.size(); ++i) all += count_[i] > 0 ? sum_[i] * sum_[i] / count_[i] : 0;
  return all;
}

double MeanRepeat::places() const {
  return static_cast<double>(std::ranges::count_if(count_, [](double n) { return n > 0; }));
}

std::size_t MeanRepeat::column(int x) const {
  return place_in(x, repeat_x_, columns_);
}

std::size_t MeanRepeat::row(int y) const {
  return place_in(y, repeat_y_, rows_) * static_cast<std::size_t>(columns_);
}

double repeating_share(const Surface& surface, double repeat_x, double repeat_y) {
  double between = 0, total = 0;
  for (int p = 0; p < 2; ++p) {
    MeanRepeat mean(repeat_x, repeat_y);
    double n = 0, sum = 0, squares = 0;
    for (int y = 0; y < surface.size().height; ++y) {
      for (int x = 0; x < surface.size().width; ++x) {
        if ((surface.status(x, y) & kNoSolution) != 0) continue;
        const double value = static_cast<double>(surface.slope(x, y, p));
        mean.add(x, y, value);
        n += 1;
        sum += value;
        squares += value * value;
      }
    }
    const double filled = mean.places();
    if (n <= filled) return 0;
    const double within = (squares - mean.squares()) / (n - filled);
    between += std::max(mean.squares() - sum * sum / n - (filled - 1) * within, 0.0);
    total += squares - sum * sum / n;
  }
  return total > 0 ? between / total : 0;
}

}  // namespace weft::material
