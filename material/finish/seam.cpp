// SPDX-License-Identifier: Apache-2.0
#include "material/finish/seam.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "material/finish/mean_repeat.h"

namespace weft::material {
namespace {

// One plane of a tile seen along the axis of a joint: places go on at the borders.
class Line {
 public:
  Line(View<const float> plane, Axis axis) : plane_(plane), axis_(axis) {}
  int along() const { return axis_ == Axis::kX ? plane_.width() : plane_.height(); }
  int across() const { return axis_ == Axis::kX ? plane_.height() : plane_.width(); }
  double at(int i, int j) const {
    i = (i % along() + along()) % along();
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

// Places a whole number of repeats away from the joint; without a repeat every eighth of the tile.
std::vector<int> elsewhere(int along, int overlap, double repeat) {
  std::vector<int> shifts;
  const double step = repeat > 0 ? repeat : along / 8.0;
  for (double shift = std::ceil(overlap / step) * step; shift + overlap <= along; shift += step)
    shifts.push_back(static_cast<int>(std::lround(shift)));
  return shifts;
}

double wrap_step(const Line& line, double repeat, int overlap) {
  double largest = 0;
  for (const int shift : elsewhere(line.along(), overlap, repeat)) {
    for (const int near : {-1, 0, 1}) largest = std::max(largest, line.step_energy(shift + near));
  }
  return largest > 0 ? std::sqrt(line.step_energy(0) / largest) : 1;
}

// Sums of `energy` over places within `reach` of the cut, and its mean over the same places elsewhere.
template <typename Energy>
double at_cut_over_elsewhere(const Line& line, const Cut& cut, const std::vector<int>& shifts, int reach,
                             Energy&& energy) {
  double here = 0, there = 0;
  for (int j = 0; j < line.across(); ++j) {
    const int column = cut.column[static_cast<std::size_t>(j)];
    for (int i = column - reach; i <= column + reach; ++i) {
      here += energy(i, j);
      for (const int shift : shifts) there += energy(i + shift, j) / static_cast<double>(shifts.size());
    }
  }
  return there > 0 ? here / there : 1;
}

}  // namespace

Seam seam_of(const Tile& tile, const Overlap& overlap, const Cut& cut, int feather, double repeat_x,
             double repeat_y) {
  const double repeat = overlap.axis == Axis::kX ? repeat_x : repeat_y;
  const Line right(tile.surface.slope.plane(0), overlap.axis), up(tile.surface.slope.plane(1), overlap.axis),
      albedo(tile.surface.albedo.plane(tile.surface.albedo.planes() / 2), overlap.axis),
      height(tile.height_mm.plane(), overlap.axis);
  const std::vector<int> shifts = elsewhere(right.along(), overlap.overlap, repeat);
  Seam seam;
  seam.overlap_px = overlap.overlap;
  seam.cut_cost = cut.cost;
  seam.wrap_step_slope =
      std::max(wrap_step(right, repeat, overlap.overlap), wrap_step(up, repeat, overlap.overlap));
  seam.wrap_step_albedo = wrap_step(albedo, repeat, overlap.overlap);
  seam.wrap_step_height = wrap_step(height, repeat, overlap.overlap);
  if (shifts.empty()) return seam;
  const auto steps = [&](const Line& line) {
    return [&line](int i, int j) { return line.step(i, j) * line.step(i, j); };
  };
  const auto both_steps = [&](int i, int j) { return steps(right)(i, j) + steps(up)(i, j); };
  seam.gradient_slope = at_cut_over_elsewhere(right, cut, shifts, feather, both_steps);
  seam.gradient_albedo = at_cut_over_elsewhere(albedo, cut, shifts, feather, steps(albedo));
  const auto curl = [&](int i, int j) {
    // One slope changes along the axis, the other across it; which way is up does not matter for the square.
    const int n = right.across(), before = (j + n - 1) % n, after = (j + 1) % n;
    const Line& along = overlap.axis == Axis::kX ? right : up;
    const Line& other = overlap.axis == Axis::kX ? up : right;
    const double c = (along.at(i, after) - along.at(i, before)) + (other.at(i + 1, j) - other.at(i - 1, j));
    return c * c;
  };
  seam.curl = std::sqrt(at_cut_over_elsewhere(right, cut, shifts, 2 * feather, curl));
  if (repeat <= 0) return seam;
  const Image<float> residual_right = without_mean_repeat(tile.surface.slope.plane(0), repeat_x, repeat_y),
                     residual_up = without_mean_repeat(tile.surface.slope.plane(1), repeat_x, repeat_y);
  const Line r(residual_right.plane(), overlap.axis), u(residual_up.plane(), overlap.axis);
  seam.residual = std::sqrt(at_cut_over_elsewhere(r, cut, shifts, feather, [&](int i, int j) {
    return r.at(i, j) * r.at(i, j) + u.at(i, j) * u.at(i, j);
  }));
  return seam;
}

}  // namespace weft::material
