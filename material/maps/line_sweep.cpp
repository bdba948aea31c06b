// SPDX-License-Identifier: Apache-2.0
#include "material/maps/line_sweep.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace weft::material {
namespace {

constexpr int kManyRows = 1 << 20;  ///< more than a line leaves the map by
constexpr float kAbsent = std::numeric_limits<float>::quiet_NaN();

int wrapped(int i, int count) {
  const int rest = i % count;
  return rest < 0 ? rest + count : rest;
}

// Slopes from each point of a line to the horizon among the points before it: the upper convex hull of those
// is a stack, whose top stays while the line to the second is below that to it.
void find_horizons(const float* z, int count, const float* inverse, int* hull_x, float* hull_z,
                   Horizons& horizons) {
  int top = 0;
  for (int x = 0; x < count; ++x) {
    const float here = z[x];
    const auto i = static_cast<std::size_t>(x);
    horizons.slope[i] = kOpenHorizon;
    horizons.inverse[i] = 0;
    if (std::isnan(here)) continue;
    if (top > 0) {
      float slope = (hull_z[top - 1] - here) * inverse[x - hull_x[top - 1]];
      while (top > 1) {
        const float behind = (hull_z[top - 2] - here) * inverse[x - hull_x[top - 2]];
        if (behind < slope) break;
        slope = behind;
        --top;
      }
      horizons.slope[i] = slope;
      horizons.inverse[i] = inverse[x - hull_x[top - 1]];
    }
    hull_x[top] = x;
    hull_z[top] = here;
    ++top;
  }
}

}  // namespace

int SweepLines::first() const {
  return static_cast<int>(
             std::floor(-(height.height() - 1) / 2.0 - (height.width() - 1) / 2.0 * std::abs(slope))) -
         1;
}

int SweepLines::last() const {
  return -first() + 1;
}

LineSweep::LineSweep(const SweepLines& lines)
    : lines_(lines),
      first_column_(lines.is_tile ? -lines.height.width() : 0),
      columns_(lines.height.width() * (lines.is_tile ? 3 : 1)) {
  const auto count = static_cast<std::size_t>(columns_);
  for (auto* values : {&z_, &walked_.slope, &walked_.inverse, &hull_z_, &inverse_}) values->resize(count);
  hull_x_.resize(count);
  for (std::size_t n = 1; n < count; ++n) inverse_[n] = 1 / static_cast<float>(n);
}

void LineSweep::sample(int line) {
  const View<const float> map = lines_.height;
  const int width = map.width(), rows = map.height();
  const double first = lines_.y_at(line, first_column_);
  for (int i = 0; i < columns_; ++i) {
    const double y = first + i * lines_.slope;
    int upper = static_cast<int>(y + kManyRows) - kManyRows;  // rounded down
    const auto part = static_cast<float>(y - upper);
    int lower = upper + (part > 0), column = first_column_ + i;
    float& z = z_[static_cast<std::size_t>(i)];
    if (lines_.is_tile) {
      column = wrapped(column, width);
      upper = wrapped(upper, rows);
      lower = wrapped(lower, rows);
    } else if (upper < 0 || lower >= rows) {
      z = kAbsent;
      continue;
    }
    const float a = map(column, upper), b = map(column, lower);
    z = a + part * (b - a);
    if (!std::isfinite(z)) z = std::isfinite(a) ? a : (std::isfinite(b) ? b : kAbsent);
  }
}

void LineSweep::walk(int line, LineHorizons& horizons) {
  const int width = lines_.height.width();
  const auto copy_inside = [&](const std::vector<float>& from, std::vector<float>& to) {
    const auto inside = from.begin() - first_column_;
    to.assign(inside, inside + width);
  };
  const auto find = [&] {
    find_horizons(z_.data(), columns_, inverse_.data(), hull_x_.data(), hull_z_.data(), walked_);
  };
  sample(line);
  find();
  copy_inside(z_, horizons.height);
  copy_inside(walked_.slope, horizons.to_left.slope);
  copy_inside(walked_.inverse, horizons.to_left.inverse);
  std::reverse(z_.begin(), z_.end());
  find();
  for (auto* values : {&walked_.slope, &walked_.inverse}) std::reverse(values->begin(), values->end());
  copy_inside(walked_.slope, horizons.to_right.slope);
  copy_inside(walked_.inverse, horizons.to_right.inverse);
}

}  // namespace weft::material
