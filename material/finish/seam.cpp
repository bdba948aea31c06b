// SPDX-License-Identifier: Apache-2.0
#include "material/finish/seam.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/image/image.h"

namespace weft::material {
namespace {

// The mean of a plane over all its repeats of `repeat_x` x `repeat_y` pixels. Places in the repeat are a
// pixel wide at most.
class MeanRepeat {
 public:
  MeanRepeat(double repeat_x, double repeat_y)
      : repeat_x_(repeat_x),
        repeat_y_(repeat_y),
        columns_(std::max(1, static_cast<int>(std::ceil(repeat_x)))),
        rows_(std::max(1, static_cast<int>(std::ceil(repeat_y)))),
        count_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)),
        sum_(count_.size()) {}

  void add(View<const float> plane) {
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

  // 0 where nothing was added.
  double at(int x, int y) const {
    const std::size_t i = row(y) + column(x);
    return count_[i] > 0 ? sum_[i] / count_[i] : 0;
  }

 private:
  static std::size_t place_in(int i, double repeat, int places) {
    const double phase = i / repeat - std::floor(i / repeat);
    return static_cast<std::size_t>(std::min(static_cast<int>(phase * places), places - 1));
  }
  std::size_t column(int x) const { return place_in(x, repeat_x_, columns_); }
  // Index of its first place.
  std::size_t row(int y) const { return place_in(y, repeat_y_, rows_) * static_cast<std::size_t>(columns_); }

  double repeat_x_, repeat_y_;
  int columns_, rows_;
  std::vector<double> count_, sum_;
};

// One plane seen along the axis of a joint: places go on at its borders.
class Line {
 public:
  Line(View<const float> plane, Axis axis) : plane_(plane), axis_(axis) {}
  int along() const { return axis_ == Axis::kX ? plane_.width() : plane_.height(); }
  int across() const { return axis_ == Axis::kX ? plane_.height() : plane_.width(); }
  double at(int i, int j) const {
    i = (i + along()) % along();
    j = (j + across()) % across();
    return static_cast<double>(axis_ == Axis::kX ? plane_(i, j) : plane_(j, i));
  }
  double step(int i, int j) const { return at(i, j) - at(i - 1, j); }
  double step_energy(int i) const {
    double sum = 0;
    for (int j = 0; j < across(); ++j) sum += step(i, j) * step(i, j);
    return sum;
  }

 private:
  View<const float> plane_;
  Axis axis_;
};

// Both slopes of a surface: along the axis of a joint and across it.
struct Slopes {
  Line along, across;

  Slopes(const Surface& surface, Axis axis)
      : along(surface.slope.plane(axis == Axis::kX ? 0 : 1), axis),
        across(surface.slope.plane(axis == Axis::kX ? 1 : 0), axis) {}
  double step(int i, int j) const { return std::hypot(along.step(i, j), across.step(i, j)); }
  double curl(int i, int j) const {
    // Rows run against the slope upwards, so both terms have one sign in either axis.
    return (along.at(i, j + 1) - along.at(i, j - 1)) + (across.at(i + 1, j) - across.at(i - 1, j));
  }
};

Line green_of(const Surface& surface, Axis axis) {
  return {surface.albedo.plane(surface.albedo.planes() / 2), axis};
}

// The rms step at the border over the largest one a whole number of repeats away.
double wrap_step(const Line& line, double repeat) {
  const double every = repeat > 0 ? repeat : line.along() / 8.0;
  double largest = 0;
  for (double shift = every; shift < line.along() - 1; shift += every) {
    for (const int near : {-1, 0, 1})
      largest = std::max(largest, line.step_energy(static_cast<int>(std::lround(shift)) + near));
  }
  return largest > 0 ? std::sqrt(line.step_energy(0) / largest) : 1;
}

// The places around a cut.
struct Band {
  const Overlap& overlap;
  const Cut& cut;
  int feather, skip, across;

  // Root of the mean square of what is there over that of the sides that were joined, each by its weight.
  template <typename Joined, typename Before>
  double ratio(Joined&& joined, Before&& before) const {
    double here = 0, sides = 0;
    for (int j = skip; j < across; ++j) {
      const int column = cut.column[static_cast<std::size_t>(j)];
      for (int i = std::max(column - 3 * feather, 1); i < std::min(column + 3 * feather, overlap.overlap);
           ++i) {
        const double now = joined(i, j), own = before(i, j), beyond = before(i + overlap.period, j);
        here += now * now;
        const double weight = own_weight(i, column, feather);
        sides += weight * own * own + (1 - weight) * beyond * beyond;
      }
    }
    return sides > 0 ? std::sqrt(here / sides) : 1;
  }
};

double residual_ratio(const Tile& tile, const Surface& before, const Band& band,
                      const TilingOptions& options) {
  double squares = 0;
  for (int p = 0; p < 2; ++p) {
    const Axis axis = band.overlap.axis;
    MeanRepeat mean(options.repeat_x_px, options.repeat_y_px);
    mean.add(before.slope.plane(p));
    const Line now(tile.surface.slope.plane(p), axis), then(before.slope.plane(p), axis);
    const auto usual = [&](int i, int j) { return axis == Axis::kX ? mean.at(i, j) : mean.at(j, i); };
    const double level = p == 0 ? tile.mean_right : tile.mean_up;
    const double ratio = band.ratio([&](int i, int j) { return now.at(i, j) + level - usual(i, j); },
                                    [&](int i, int j) { return then.at(i, j) - usual(i, j); });
    squares += ratio * ratio / 2;
  }
  return std::sqrt(squares);
}

}  // namespace

Seam seam_of(const Tile& tile, const Surface& before, const Overlap& overlap, const Cut& cut, int skip,
             const TilingOptions& options) {
  const Axis axis = overlap.axis;
  const double repeat = axis == Axis::kX ? options.repeat_x_px : options.repeat_y_px;
  const Slopes slopes(tile.surface, axis), slopes_before(before, axis);
  const Line albedo = green_of(tile.surface, axis), albedo_before = green_of(before, axis);
  const Band band = {overlap, cut, options.feather_px, skip, albedo.across()};
  const auto squared = [](double ratio) { return ratio * ratio; };
  Seam seam;
  seam.overlap_px = overlap.overlap;
  seam.cut_cost = cut.cost;
  seam.wrap_step_slope = std::max(wrap_step(slopes.along, repeat), wrap_step(slopes.across, repeat));
  seam.wrap_step_albedo = wrap_step(albedo, repeat);
  seam.wrap_step_height = wrap_step(Line(tile.height_mm.plane(), axis), repeat);
  seam.gradient_slope = squared(band.ratio([&](int i, int j) { return slopes.step(i, j); },
                                           [&](int i, int j) { return slopes_before.step(i, j); }));
  seam.gradient_albedo = squared(band.ratio([&](int i, int j) { return albedo.step(i, j); },
                                            [&](int i, int j) { return albedo_before.step(i, j); }));
  seam.curl = band.ratio([&](int i, int j) { return slopes.curl(i, j); },
                         [&](int i, int j) { return slopes_before.curl(i, j); });
  if (tile.has_repeat) seam.residual = residual_ratio(tile, before, band, options);
  return seam;
}

}  // namespace weft::material
