// SPDX-License-Identifier: Apache-2.0
#include "solver/registration/smooth_shifts.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace weft::solver {
namespace {

constexpr double kSigma_px = 1.3;
constexpr int kReach = 5;
constexpr int kMargin = 14;  // kMostShift_px, the reach and one for the fraction, rounded to a whole cell
static_assert(kMargin >= kMostShift_px + kReach + 1 && kMargin % 2 == 0);

// A site's offset from a point, its weight and the weight's slope with respect to the point.
struct Tap {
  int offset;
  double weight, slope;
};

// Taps along one axis of a point that lies `shift` beyond a pixel, where `keep(offset)`.
template <typename Keep>
std::vector<Tap> taps(double shift, const Keep& keep) {
  std::vector<Tap> all;
  const int base = static_cast<int>(std::floor(shift));
  for (int offset = base - kReach; offset <= base + kReach + 1; ++offset) {
    if (!keep(offset)) continue;
    const double r = (offset - shift) / kSigma_px, g = std::exp(-r * r / 2);
    all.push_back({offset, g * (3 - r * r) / 2, g * r * (5 - r * r) / 2 / kSigma_px});
  }
  return all;
}

struct Sums {
  double weight = 0, slope = 0, weight2 = 0, slope2 = 0;
};
Sums sums_of(const std::vector<Tap>& all) {
  Sums s;
  for (const Tap& t : all) {
    s.weight += t.weight;
    s.slope += t.slope;
    s.weight2 += t.weight * t.weight;
    s.slope2 += t.slope * t.slope;
  }
  return s;
}

}  // namespace

PointGrid::PointGrid(Size tile)
    : columns(std::max(0, (tile.width - 2 * kMargin + 1) / 2)),
      rows(std::max(0, (tile.height - 2 * kMargin + 1) / 2)) {}

int PointGrid::pixel(int index) {
  return kMargin + 2 * index;
}

SmoothShot smooth(View<const float> readings, bool mosaic, const CfaPattern& cfa,
                  ClothShift::Displacement shift, const PointGrid& grid) {
  // Points lie on even pixels, so the parity of a site is that of its offset.
  const std::vector<Tap> down = taps(shift.y, [](int) { return true; });
  std::array<std::vector<Tap>, 2> across;
  std::array<Sums, 2> sums;
  for (int parity = 0; parity < 2; ++parity) {
    const auto p = static_cast<std::size_t>(parity);
    across[p] = taps(shift.x, [&](int offset) { return !mosaic || cfa.channel_at(offset & 1, parity) == 1; });
    sums[p] = sums_of(across[p]);
  }
  Sums total, slope_x, slope_y;  // of the products of both axes
  for (const Tap& t : down) {
    const Sums& s = sums[static_cast<std::size_t>(t.offset & 1)];
    total.weight += t.weight * s.weight;
    total.weight2 += t.weight * t.weight * s.weight2;
    slope_x.slope += t.weight * s.slope;
    slope_x.slope2 += t.weight * t.weight * s.slope2;
    slope_y.slope += t.slope * s.weight;
    slope_y.slope2 += t.slope * t.slope * s.weight2;
  }
  SmoothShot out;
  const double w = total.weight;
  out.noise = total.weight2 / (w * w);
  out.slope_noise = (slope_x.slope2 + slope_y.slope2) / 2 / (w * w);

  const auto columns = static_cast<std::size_t>(grid.columns);
  const auto pixels = static_cast<std::size_t>(readings.height());
  std::vector<float> value(columns * pixels), slope(columns * pixels);
  for (int y = 0; y < readings.height() && grid.count() > 0; ++y) {
    for (int i = 0; i < grid.columns; ++i) {
      double v = 0, d = 0;
      for (const Tap& t : across[static_cast<std::size_t>(y & 1)]) {
        const double r = readings(PointGrid::pixel(i) + t.offset, y);
        v += t.weight * r;
        d += t.slope * r;
      }
      const std::size_t at = static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(i);
      value[at] = static_cast<float>(v);
      slope[at] = static_cast<float>(d);
    }
  }
  for (int j = 0; j < grid.rows; ++j) {
    for (std::size_t i = 0; i < columns; ++i) {
      double v = 0, dx = 0, dy = 0;
      for (const Tap& t : down) {
        const std::size_t at = static_cast<std::size_t>(PointGrid::pixel(j) + t.offset) * columns + i;
        v += t.weight * value[at];
        dx += t.weight * slope[at];
        dy += t.slope * value[at];
      }
      // Divided by weights that depend on the point: the slope of a quotient.
      out.value.push_back(static_cast<float>(v / w));
      out.dx.push_back(static_cast<float>((dx - v / w * slope_x.slope) / w));
      out.dy.push_back(static_cast<float>((dy - v / w * slope_y.slope) / w));
    }
  }
  return out;
}

}  // namespace weft::solver
