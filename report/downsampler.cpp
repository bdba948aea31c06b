// SPDX-License-Identifier: Apache-2.0
#include "report/downsampler.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/solve/solve_record.h"

namespace weft::report {
namespace {

int ceil_div(int a, int b) {
  return a / b + (a % b != 0 ? 1 : 0);
}

int square_for(Size size, int longest_side) {
  return std::max(1, ceil_div(std::max(size.width, size.height), std::max(1, longest_side)));
}

}  // namespace

Downsampler::Downsampler(Size size, int planes, int longest_side)
    : size_(size),
      square_(square_for(size, longest_side)),
      averages_({ceil_div(size.width, square_), ceil_div(size.height, square_)}, planes),
      column_sums_({size.width, 1}, planes),
      column_counts_(static_cast<std::size_t>(size.width)),
      weight_(static_cast<std::size_t>(size.width)) {
  for (int p = 0; p < planes; ++p) {
    for (int y = 0; y < averages_.height(); ++y) {
      std::fill_n(averages_.plane(p).row(y), averages_.width(), std::numeric_limits<float>::quiet_NaN());
    }
  }
}

void Downsampler::add_rows(std::span<const View<const float>> planes, View<const std::uint16_t> status) {
  const std::size_t width = weight_.size();
  const int rows = planes.empty() ? 0 : std::min(planes.front().height(), size_.height - rows_);
  for (int y = 0; y < rows; ++y) {
    std::fill(weight_.begin(), weight_.end(), 1.0f);
    for (const View<const float>& plane : planes) {
      const float* value = plane.row(y);
      // 0 times what is not finite is NaN.
      for (std::size_t x = 0; x < width; ++x) weight_[x] = 0.0f * value[x] == 0.0f ? weight_[x] : 0.0f;
    }
    if (!status.empty()) {
      const std::uint16_t* bits = status.row(y);
      for (std::size_t x = 0; x < width; ++x) weight_[x] = (bits[x] & kNoSolution) == 0 ? weight_[x] : 0.0f;
    }
    for (std::size_t x = 0; x < width; ++x) column_counts_[x] += static_cast<std::uint32_t>(weight_[x]);
    for (std::size_t p = 0; p < planes.size(); ++p) {
      const float* value = planes[p].row(y);
      double* sum = column_sums_.plane(static_cast<int>(p)).row(0);
      for (std::size_t x = 0; x < width; ++x) sum[x] += weight_[x] != 0.0f ? value[x] : 0.0f;
    }
    ++rows_;
    if (rows_ % square_ == 0 || rows_ == size_.height) finish_squares();
  }
}

void Downsampler::finish_squares() {
  const int row = (rows_ - 1) / square_;
  for (int column = 0; column < averages_.width(); ++column) {
    const int x0 = column * square_, x1 = std::min(x0 + square_, size_.width);
    const std::int64_t pixels = std::int64_t{rows_ - row * square_} * (x1 - x0);
    std::int64_t count = 0;
    for (int x = x0; x < x1; ++x) count += std::exchange(column_counts_[static_cast<std::size_t>(x)], 0);
    missing_ += pixels - count;
    for (int p = 0; p < averages_.planes(); ++p) {
      double sum = 0;
      for (int x = x0; x < x1; ++x) sum += std::exchange(column_sums_(x, 0, p), 0.0);
      if (2 * count > pixels)
        averages_(column, row, p) = static_cast<float>(sum / static_cast<double>(count));
    }
  }
}

}  // namespace weft::report
