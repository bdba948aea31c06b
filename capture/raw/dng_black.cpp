// SPDX-License-Identifier: Apache-2.0
#include "capture/raw/dng_black.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace weft::capture {
namespace {

/// Mean of every second value from `from` on; 0 where there are none.
double mean_of_every_second(const std::vector<double>& values, std::size_t from) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = from; i < values.size(); i += 2) sum += values[i], ++count;
  return count == 0 ? 0 : sum / count;
}

}  // namespace

DngBlack::DngBlack(std::vector<double> pattern, std::size_t columns, std::vector<double> by_column,
                   std::vector<double> by_row)
    : pattern_(std::move(pattern)),
      by_column_(std::move(by_column)),
      by_row_(std::move(by_row)),
      columns_(columns) {
  const std::size_t rows = pattern_.size() / columns_;
  for (std::size_t y = 0; y < 2; ++y)
    for (std::size_t x = 0; x < 2; ++x) {
      double sum = 0;
      for (std::size_t j = 0; j < rows; ++j)
        for (std::size_t i = 0; i < columns_; ++i) sum += pattern_at(x + 2 * i, y + 2 * j);
      cell_[y][x] =
          static_cast<float>(sum / static_cast<double>(pattern_.size()) +
                             mean_of_every_second(by_column_, x) + mean_of_every_second(by_row_, y));
    }
}

double DngBlack::pattern_at(std::size_t x, std::size_t y) const {
  const std::size_t rows = pattern_.size() / columns_;
  return pattern_[y % rows * columns_ + x % columns_];
}

void DngBlack::level(View<std::uint16_t> counts, float white) const {
  const bool is_cell = columns_ <= 2 && pattern_.size() / columns_ <= 2;
  if (is_cell && by_column_.empty() && by_row_.empty()) return;
  for (int y = 0; y < counts.height(); ++y) {
    const auto j = static_cast<std::size_t>(y);
    std::uint16_t* const row = counts.row(y);
    for (int x = 0; x < counts.width(); ++x) {
      if (static_cast<float>(row[x]) >= white) continue;
      const auto i = static_cast<std::size_t>(x);
      double black = pattern_at(i, j);
      if (!by_column_.empty()) black += by_column_[i];
      if (!by_row_.empty()) black += by_row_[j];
      const double level = row[x] - std::round(black - static_cast<double>(cell_[j & 1][i & 1]));
      row[x] = static_cast<std::uint16_t>(std::clamp(level, 0.0, 65535.0));
    }
  }
}

}  // namespace weft::capture
