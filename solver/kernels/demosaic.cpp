// SPDX-License-Identifier: Apache-2.0
#include "solver/kernels/demosaic.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/kernels/demosaic.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace weft::solver {

#ifndef WEFT_DEMOSAIC_ROW
#define WEFT_DEMOSAIC_ROW
struct DemosaicRow {
  const float* from[5];  // rows y - 2 to y + 2 at the area's first column
  float* rgb[3];
  std::size_t width;
  bool red_row;       // the row has red sites, else blue ones
  bool green_is_odd;  // green on odd columns, else on even ones
};
#endif

namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

// kSigma: the values are standard deviations, and squares of weights go with their squares.
template <bool kSigma>
void demosaic_row(const DemosaicRow& row) {
  const D d;
  const auto weight = [&](float w) { return hn::Set(d, kSigma ? w * w / 64 : w / 8); };
  const auto load = [&](int dy, int dx, std::size_t x) {
    const V v = hn::LoadU(d, row.from[dy + 2] + static_cast<std::ptrdiff_t>(x) + dx);
    return kSigma ? hn::Mul(v, v) : v;
  };
  for (std::size_t x = 0; x < row.width; x += hn::Lanes(d)) {
    const V centre = load(0, 0, x);
    const V across = hn::Add(load(0, -1, x), load(0, 1, x)),
            far_across = hn::Add(load(0, -2, x), load(0, 2, x));
    const V down = hn::Add(load(-1, 0, x), load(1, 0, x)), far_down = hn::Add(load(-2, 0, x), load(2, 0, x));
    const V diagonal =
        hn::Add(hn::Add(load(-1, -1, x), load(-1, 1, x)), hn::Add(load(1, -1, x), load(1, 1, x)));
    const auto sum = [&](float c, float a, float fa, float v, float fv, float dg) {
      V s = hn::Mul(weight(c), centre);
      s = hn::MulAdd(weight(a), across, s);
      s = hn::MulAdd(weight(v), down, s);
      // A square has no sign: for values the weights of the far sites may be negative.
      const auto add = [&](float w, V value) {
        s = kSigma || w >= 0 ? hn::MulAdd(weight(w), value, s) : hn::NegMulAdd(weight(-w), value, s);
      };
      add(fa, far_across);
      add(fv, far_down);
      add(dg, diagonal);
      return kSigma ? hn::Sqrt(s) : s;
    };
    const V green_at_other = sum(4, 2, -1, 2, -1, 0);
    const V along_row = sum(5, 4, -1, 0, 0.5f, -1);
    const V along_column = sum(5, 0, 0.5f, 4, -1, -1);
    const V opposite = sum(6, 0, -1.5f, 0, -1.5f, 2);
    const V own = kSigma ? hn::Sqrt(centre) : centre;
    const auto choose = [&](V at_green, V at_other) {
      if (hn::Lanes(d) == 1) return ((x & 1) != 0) == row.green_is_odd ? at_green : at_other;
      return row.green_is_odd ? hn::OddEven(at_green, at_other) : hn::OddEven(at_other, at_green);
    };
    const std::size_t row_colour = row.red_row ? 0 : 2;
    hn::StoreU(choose(along_row, own), d, row.rgb[row_colour] + x);
    hn::StoreU(choose(own, green_at_other), d, row.rgb[1] + x);
    hn::StoreU(choose(along_column, opposite), d, row.rgb[2 - row_colour] + x);
  }
}

void demosaic_values(const DemosaicRow& row) {
  demosaic_row<false>(row);
}
void demosaic_deviations(const DemosaicRow& row) {
  demosaic_row<true>(row);
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace weft::solver {

HWY_EXPORT(demosaic_values);
HWY_EXPORT(demosaic_deviations);

namespace {

// Reflection about the outermost site keeps its colour; for images of one or two sites it settles inside.
int mirrored(int i, int count) {
  if (count == 1) return 0;
  while (i < 0 || i >= count) i = i < 0 ? -i : 2 * (count - 1) - i;
  return i;
}

void run(View<const float> mosaic, const CfaPattern& cfa, Rect area, const std::array<View<float>, 3>& rgb,
         void (*row_kernel)(const DemosaicRow&)) {
  const std::ptrdiff_t padded = area.width() + 2 * kDemosaicReach + kRowGroup;
  std::vector<float> lines(static_cast<std::size_t>(5 * padded));
  // Row `y` of the mosaic, mirrored at the edges, from column area.x0 - kDemosaicReach.
  const auto line = [&](int y) { return lines.data() + ((y - area.y0 + 5) % 5) * padded; };
  const auto fill = [&](int y) {
    const float* from = mosaic.row(mirrored(y, mosaic.height()));
    float* to = line(y);
    const int left = area.x0 - kDemosaicReach, right = area.x1 + kDemosaicReach;
    const int whole0 = std::max(left, 0), whole1 = std::min(right, mosaic.width());
    for (int x = left; x < whole0; ++x) to[x - left] = from[mirrored(x, mosaic.width())];
    std::copy(from + whole0, from + whole1, to + (whole0 - left));
    for (int x = whole1; x < right; ++x) to[x - left] = from[mirrored(x, mosaic.width())];
  };
  for (int y = area.y0 - kDemosaicReach; y < area.y0 + kDemosaicReach; ++y) fill(y);
  for (int y = area.y0; y < area.y1; ++y) {
    fill(y + kDemosaicReach);
    DemosaicRow row;
    for (int i = 0; i < 5; ++i) row.from[i] = line(y - kDemosaicReach + i) + kDemosaicReach;
    for (std::size_t c = 0; c < 3; ++c) row.rgb[c] = rgb[c].row(y - area.y0);
    row.width = static_cast<std::size_t>(area.width());
    row.green_is_odd = cfa.channel_at(1, y) == 1;
    row.red_row = cfa.channel_at(row.green_is_odd ? 0 : 1, y) == 0;
    row_kernel(row);
  }
}

}  // namespace

void demosaic(View<const float> mosaic, const CfaPattern& cfa, Rect area,
              const std::array<View<float>, 3>& rgb) {
  run(mosaic, cfa, area, rgb, HWY_DYNAMIC_DISPATCH(demosaic_values));
}

void demosaic_sigma(View<const float> sigma, const CfaPattern& cfa, Rect area,
                    const std::array<View<float>, 3>& rgb) {
  run(sigma, cfa, area, rgb, HWY_DYNAMIC_DISPATCH(demosaic_deviations));
}

}  // namespace weft::solver
#endif
