// SPDX-License-Identifier: Apache-2.0
#include "solver/height/cell_spline.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace weft::solver {
namespace {

constexpr int kMargin = 3;
/// How the way from slopes to this surface blurs, as variance in cells squared: the cubic B-spline 1/3, the
/// mean over a cell 1/12, and steps that are the mean of two cells' slopes 1/6.
constexpr float kBlur = 7.0f / 12;

/// The four coefficients that a pixel draws on, and what each counts for its value and for its derivative a
/// pixel.
struct Knot {
  int first = 0;
  std::array<float, 4> value = {}, slope = {};
};

Knot knot_at(int pixel) {
  const double place = (pixel + 0.5) / CellSpline::kCell - 0.5;
  const double below = std::floor(place), t = place - below, s = 1 - t;
  const auto f = [](double v) { return static_cast<float>(v); };
  const auto g = [](double v) { return static_cast<float>(v / CellSpline::kCell); };
  return {static_cast<int>(below) - 1 + kMargin,
          {f(s * s * s / 6), f((3 * t * t * t - 6 * t * t + 4) / 6), f((3 * s * s * s - 6 * s * s + 4) / 6),
           f(t * t * t / 6)},
          {g(-s * s / 2), g(1.5 * t * t - 2 * t), g(2 * s - 1.5 * s * s), g(t * t / 2)}};
}

// kMargin values beyond each end of a line of `count`, in a straight line with the last two.
template <typename At>
void continue_line(int count, const At& at) {
  const int first = kMargin, last = kMargin + count - 1;
  const float at_first = at(first), at_last = at(last);
  const float before = count > 1 ? at_first - at(first + 1) : 0,
              after = count > 1 ? at_last - at(last - 1) : 0;
  for (int i = 1; i <= kMargin; ++i) {
    at(first - i) = at_first + static_cast<float>(i) * before;
    at(last + i) = at_last + static_cast<float>(i) * after;
  }
}

}  // namespace

Size CellSpline::cells_of(Size size) {
  return {std::max(size.width / kCell, 1), std::max(size.height / kCell, 1)};
}

CellSpline::CellSpline(View<const float> cells)
    : coefficients_({cells.width() + 2 * kMargin, cells.height() + 2 * kMargin}) {
  extend(cells);
  sharpen();
}

void CellSpline::extend(View<const float> cells) {
  for (int y = 0; y < cells.height(); ++y) {
    std::copy_n(cells.row(y), cells.width(), &coefficients_(kMargin, y + kMargin));
    continue_line(cells.width(), [&](int x) -> float& { return coefficients_(x, y + kMargin); });
  }
  for (int x = 0; x < coefficients_.width(); ++x) {
    continue_line(cells.height(), [&](int y) -> float& { return coefficients_(x, y); });
  }
}

void CellSpline::sharpen() {
  const Image<float> blurred = std::exchange(coefficients_, Image<float>(coefficients_.size()));
  const int right = blurred.width() - 1, bottom = blurred.height() - 1;
  for (int y = 0; y <= bottom; ++y) {
    for (int x = 0; x <= right; ++x) {
      const float here = blurred(x, y);
      const bool inside_x = x > 0 && x<right, inside_y = y> 0 && y < bottom;
      const float bend_x = inside_x ? blurred(x - 1, y) - 2 * here + blurred(x + 1, y) : 0;
      const float bend_y = inside_y ? blurred(x, y - 1) - 2 * here + blurred(x, y + 1) : 0;
      coefficients_(x, y) = here - kBlur * (bend_x + bend_y) / 2;
    }
  }
}

void CellSpline::read(int y, int width, Row& row) const {
  for (auto* values : {&row.height, &row.right, &row.down}) values->resize(static_cast<std::size_t>(width));
  const Knot down = knot_at(y);
  std::vector<float> value(static_cast<std::size_t>(coefficients_.width())), slope(value.size());
  for (std::size_t k = 0; k < 4; ++k) {
    const float* from = coefficients_.plane().row(down.first + static_cast<int>(k));
    for (std::size_t x = 0; x < value.size(); ++x) {
      value[x] += down.value[k] * from[x];
      slope[x] += down.slope[k] * from[x];
    }
  }
  std::array<Knot, kCell> across;  // by column within a cell
  for (int x = 0; x < kCell; ++x) across[static_cast<std::size_t>(x)] = knot_at(x);
  for (int x = 0; x < width; ++x) {
    const Knot& knot = across[static_cast<std::size_t>(x % kCell)];
    const auto i = static_cast<std::size_t>(x), at = static_cast<std::size_t>(knot.first + x / kCell);
    const float *v = value.data() + at, *s = slope.data() + at;
    row.height[i] = knot.value[0] * v[0] + knot.value[1] * v[1] + knot.value[2] * v[2] + knot.value[3] * v[3];
    row.right[i] = knot.slope[0] * v[0] + knot.slope[1] * v[1] + knot.slope[2] * v[2] + knot.slope[3] * v[3];
    row.down[i] = knot.value[0] * s[0] + knot.value[1] * s[1] + knot.value[2] * s[2] + knot.value[3] * s[3];
  }
}

}  // namespace weft::solver
