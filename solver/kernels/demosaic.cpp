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

#include "solver/kernels/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft::solver {

#ifndef WEFT_DEMOSAIC_ROW
#define WEFT_DEMOSAIC_ROW
struct DemosaicRow {
  // Rows y - 2 to y + 2, even and odd columns apart, from the area's first column.
  const float *value[5][2], *variance[5][2];
  float *rgb[3], *sigma[3];
  std::size_t width;
  bool red_row;       // the row has red sites, else blue ones
  bool green_is_odd;  // green on odd columns, else on even ones
};
#endif

namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Changes of less than a thousandth of the value, or of next to nothing, are none.
constexpr float kLeastChange2 = 1e-6f, kLeast2 = 1e-30f;
// The square of a change that all neighbours share is taken to go along with the missing colour as if seen to
// by so much.
constexpr float kSharedGoesAlong = 0.25f;
// A share of the mean square of the changes: less is no reason to prefer one neighbour to another.
constexpr float kPreferFrom2 = 0.1f;
// Squares of standard deviations within which a change counts as none, and as noise.
constexpr float kNoChange2 = 4, kNoise2 = 9;

// Sites in every second column.
class Sites {
 public:
  Sites(const DemosaicRow& row, std::size_t pair, bool odd)
      : row_(&row), pair_(static_cast<std::ptrdiff_t>(pair)), odd_(odd ? 1 : 0) {}

  HWY_INLINE V value(int dx, int dy) const { return load(row_->value, dx, dy); }
  HWY_INLINE V variance(int dx, int dy) const { return load(row_->variance, dx, dy); }

 private:
  HWY_INLINE V load(const float* const (&lines)[5][2], int dx, int dy) const {
    const int column = odd_ + dx;
    return hn::LoadU(D(), lines[dy + 2][column & 1] + pair_ + (column >> 1));
  }

  const DemosaicRow* row_;
  std::ptrdiff_t pair_;
  int odd_;
};

// The neighbours that measured a colour which the sites did not, opposite ones side by side.
template <std::size_t kCount>
struct Neighbours {
  V value[kCount], variance[kCount];
  V change[kCount];  // of the colour that the sites measured, to there
  V own;             // that colour at the sites
  V own_variance;
  float change_share;  // variance of a change, in units of own_variance
};

template <bool kHasSigma, std::size_t kCount>
HWY_INLINE Neighbours<kCount> neighbours_of(D d, const Sites& sites, const int (&at)[kCount][2],
                                            float change_share) {
  Neighbours<kCount> all;
  HWY_UNROLL(4)
  for (std::size_t i = 0; i < kCount; ++i) {
    all.value[i] = sites.value(at[i][0], at[i][1]);
    all.variance[i] = kHasSigma ? sites.variance(at[i][0], at[i][1]) : hn::Zero(d);
  }
  all.own = sites.value(0, 0);
  all.own_variance = kHasSigma ? sites.variance(0, 0) : hn::Zero(d);
  all.change_share = change_share;
  return all;
}

// To the mean of three sites and the own one.
HWY_INLINE V change_to(D d, V own, V a, V b, V c) {
  return hn::MulSub(hn::Set(d, 0.25f), hn::Add(a, hn::Add(b, c)), hn::Mul(hn::Set(d, 0.75f), own));
}

// Green about a red or blue site.
template <bool kHasSigma>
HWY_INLINE Neighbours<4> cross_of(D d, const Sites& sites) {
  constexpr int kAt[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
  Neighbours<4> all = neighbours_of<kHasSigma>(d, sites, kAt, 0.5f);
  HWY_UNROLL(4)
  for (std::size_t i = 0; i < 4; ++i) {
    const V there = sites.value(2 * kAt[i][0], 2 * kAt[i][1]);
    all.change[i] = hn::Mul(hn::Set(d, 0.5f), hn::Sub(there, all.own));
  }
  return all;
}

// Red about a blue site, or blue about a red one.
template <bool kHasSigma>
HWY_INLINE Neighbours<4> corners_of(D d, const Sites& sites) {
  constexpr int kAt[4][2] = {{-1, -1}, {1, 1}, {1, -1}, {-1, 1}};
  Neighbours<4> all = neighbours_of<kHasSigma>(d, sites, kAt, 0.75f);
  HWY_UNROLL(4)
  for (std::size_t i = 0; i < 4; ++i) {
    const int dx = 2 * kAt[i][0], dy = 2 * kAt[i][1];
    all.change[i] = change_to(d, all.own, sites.value(dx, 0), sites.value(0, dy), sites.value(dx, dy));
  }
  return all;
}

// Red or blue on both sides of a green site, within its row or its column.
template <bool kHasSigma, bool kInRow>
HWY_INLINE Neighbours<2> sides_of(D d, const Sites& sites) {
  constexpr int kX = kInRow ? 1 : 0, kY = kInRow ? 0 : 1;
  constexpr int kAt[2][2] = {{-kX, -kY}, {kX, kY}};
  Neighbours<2> all = neighbours_of<kHasSigma>(d, sites, kAt, 0.75f);
  HWY_UNROLL(4)
  for (std::size_t i = 0; i < 2; ++i) {
    const int dx = kAt[i][0], dy = kAt[i][1];
    all.change[i] = change_to(d, all.own, sites.value(2 * dx, 2 * dy), sites.value(dx - kY, dy - kX),
                              sites.value(dx + kY, dy + kX));
  }
  return all;
}

template <std::size_t kCount>
HWY_INLINE V mean_of(D d, const V (&values)[kCount]) {
  V sum = hn::Add(values[0], values[1]);
  if constexpr (kCount == 4) sum = hn::Add(sum, hn::Add(values[2], values[3]));
  return hn::Mul(hn::Set(d, 1.0f / kCount), sum);
}

// Orthogonal differences of neighbours: the sum of their products is twice that of the deviations from the
// mean.
template <std::size_t kCount>
struct Differences {
  V of[kCount - 1];

  HWY_INLINE Differences(D d, const V (&values)[kCount]) {
    of[0] = hn::Sub(values[0], values[1]);
    if constexpr (kCount == 4) {
      of[1] = hn::Sub(values[2], values[3]);
      const V between = hn::Sub(hn::Add(values[0], values[1]), hn::Add(values[2], values[3]));
      of[2] = hn::Mul(hn::Set(d, 0.70710678f), between);
    }
  }
  HWY_INLINE V times(const Differences& other) const {
    V sum = hn::Mul(of[0], other.of[0]);
    HWY_UNROLL(4)
    for (std::size_t i = 1; i + 1 < kCount; ++i) sum = hn::MulAdd(of[i], other.of[i], sum);
    return sum;
  }
};

// The share, 0 to 1, of their neighbours' changes in which both colours go along.
template <std::size_t kCount>
HWY_INLINE V going_along(D d, const Neighbours<kCount>& all, V noise) {
  const V mean_change = mean_of(d, all.change);
  const Differences<kCount> value(d, all.value), change(d, all.change);
  const V shared = hn::Mul(hn::Set(d, 2 * kSharedGoesAlong * kCount), hn::Mul(mean_change, mean_change));
  const V all_changes = hn::Add(hn::Max(value.times(value), change.times(change)), hn::Add(shared, noise));
  const V together = hn::MulAdd(hn::Set(d, 2.0f), value.times(change), shared);
  const V share = hn::Mul(together, reciprocal(d, all_changes));
  return hn::Min(hn::Max(share, hn::Zero(d)), hn::Set(d, 1.0f));
}

// Weights that sum to 1: alike by `share`, for the rest by how little the measured colour changes.
template <std::size_t kCount>
HWY_INLINE void weigh(D d, const Neighbours<kCount>& all, V share, V no_change, V (&weight)[kCount]) {
  V changes2 = hn::Zero(d), sum = changes2;
  HWY_UNROLL(4)
  for (const V& change : all.change) changes2 = hn::MulAdd(change, change, changes2);
  const V least = hn::MulAdd(hn::Set(d, kPreferFrom2 / kCount), changes2, no_change);
  HWY_UNROLL(4)
  for (std::size_t i = 0; i < kCount; ++i) {
    weight[i] = reciprocal(d, hn::MulAdd(all.change[i], all.change[i], least));
    sum = hn::Add(sum, weight[i]);
  }
  const V by_change = hn::Mul(hn::Sub(hn::Set(d, 1.0f), share), reciprocal(d, sum));
  const V alike = hn::Mul(share, hn::Set(d, 1.0f / kCount));
  HWY_UNROLL(4)
  for (V& w : weight) w = hn::MulAdd(w, by_change, alike);
}

struct Estimate {
  V value, variance;
};

template <bool kHasSigma, std::size_t kCount>
HWY_INLINE Estimate interpolated(D d, const Neighbours<kCount>& all) {
  const V least = hn::MulAdd(hn::Set(d, kLeastChange2), hn::Mul(all.own, all.own), hn::Set(d, kLeast2));
  const V change_variance = hn::MulAdd(hn::Set(d, all.change_share), all.own_variance, least);
  const V value_variance = mean_of(d, all.variance);
  const V noise = hn::Set(d, kNoise2);
  const V share = going_along(
      d, all, hn::Mul(hn::Set(d, 2 * kNoise2 * kCount), hn::Add(value_variance, change_variance)));
  V weight[kCount];
  weigh(d, all, share, hn::Mul(hn::Set(d, kNoChange2), change_variance), weight);

  V corrected[kCount], value = hn::Zero(d), lowest = all.value[0];
  HWY_UNROLL(4)
  for (std::size_t i = 0; i < kCount; ++i) {
    corrected[i] = hn::NegMulAdd(share, all.change[i], all.value[i]);
    value = hn::MulAdd(weight[i], corrected[i], value);
    lowest = hn::Min(lowest, all.value[i]);
  }
  const V zero = hn::Zero(d);
  Estimate estimate = {hn::IfThenElse(hn::And(hn::Lt(value, zero), hn::Ge(lowest, zero)), zero, value), zero};
  if constexpr (kHasSigma) {
    V squares = zero, errors = zero, disagreement = zero;
    HWY_UNROLL(4)
    for (std::size_t i = 0; i < kCount; ++i) {
      const V w2 = hn::Mul(weight[i], weight[i]), off = hn::Sub(corrected[i], value);
      squares = hn::Add(squares, w2);
      errors = hn::MulAdd(w2, all.variance[i], errors);
      disagreement = hn::MulAdd(w2, hn::Mul(off, off), disagreement);
    }
    const V of_share = hn::Mul(hn::Mul(share, share), change_variance);
    const V beyond = hn::NegMulAdd(noise, hn::Add(value_variance, of_share),
                                   hn::Mul(disagreement, reciprocal(d, squares)));
    estimate.variance = hn::Add(hn::Add(errors, of_share), hn::Max(beyond, zero));
  }
  return estimate;
}

template <bool kHasSigma>
void demosaic_row(const DemosaicRow& row) {
  const D d;
  const std::size_t row_colour = row.red_row ? 0 : 2;
  for (std::size_t pair = 0; 2 * pair < row.width; pair += hn::Lanes(d)) {
    const Sites greens(row, pair, row.green_is_odd), others(row, pair, !row.green_is_odd);
    const auto measured = [&](const Sites& sites) {
      return Estimate{sites.value(0, 0), kHasSigma ? sites.variance(0, 0) : hn::Zero(d)};
    };
    const auto store = [&](std::size_t channel, const Estimate& at_green, const Estimate& at_other) {
      const auto put = [&](V green, V other, float* to) {
        hn::StoreInterleaved2(row.green_is_odd ? other : green, row.green_is_odd ? green : other, d,
                              to + 2 * pair);
      };
      put(at_green.value, at_other.value, row.rgb[channel]);
      if constexpr (kHasSigma)
        put(hn::Sqrt(at_green.variance), hn::Sqrt(at_other.variance), row.sigma[channel]);
    };
    store(row_colour, interpolated<kHasSigma>(d, sides_of<kHasSigma, true>(d, greens)), measured(others));
    store(1, measured(greens), interpolated<kHasSigma>(d, cross_of<kHasSigma>(d, others)));
    store(2 - row_colour, interpolated<kHasSigma>(d, sides_of<kHasSigma, false>(d, greens)),
          interpolated<kHasSigma>(d, corners_of<kHasSigma>(d, others)));
  }
}

// Even and odd columns of `count` values, or of their squares.
template <typename Convert>
HWY_INLINE void split_row(const float* from, std::ptrdiff_t count, float* even, float* odd,
                          const Convert& convert) {
  const D d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  for (std::ptrdiff_t pair = 0; 2 * pair < count; pair += lanes) {
    V at_even, at_odd;
    hn::LoadInterleaved2(d, from + 2 * pair, at_even, at_odd);
    hn::StoreU(convert(at_even), d, even + pair);
    hn::StoreU(convert(at_odd), d, odd + pair);
  }
}

void split_values(const float* from, std::ptrdiff_t count, float* even, float* odd) {
  split_row(from, count, even, odd, [](V v) { return v; });
}
void split_variances(const float* from, std::ptrdiff_t count, float* even, float* odd) {
  // Anything larger is as unknown, and its square is no longer a float.
  const V most = hn::Set(D(), 1e15f);
  split_row(from, count, even, odd, [&](V sigma) {
    const V s = hn::Min(sigma, most);
    return hn::Mul(s, s);
  });
}

void demosaic_values(const DemosaicRow& row) {
  demosaic_row<false>(row);
}
void demosaic_with_sigma(const DemosaicRow& row) {
  demosaic_row<true>(row);
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace weft::solver {

HWY_EXPORT(split_values);
HWY_EXPORT(split_variances);
HWY_EXPORT(demosaic_values);
HWY_EXPORT(demosaic_with_sigma);

namespace {

// Reflection about the outermost site keeps its colour; for images of one or two sites it settles inside.
int mirrored(int i, int count) {
  if (count == 1) return 0;
  while (i < 0 || i >= count) i = i < 0 ? -i : 2 * (count - 1) - i;
  return i;
}

// The rows of a map around the one that is filled, even and odd columns apart.
class Lines {
 public:
  using Split = void (*)(const float* from, std::ptrdiff_t count, float* even, float* odd);

  Lines(View<const float> from, Rect area, Split split)
      : from_(from),
        area_(area),
        split_(split),
        half_(area.width() / 2 + kDemosaicReach + kRowGroup),
        data_(static_cast<std::size_t>(kKept * 2 * half_)) {}

  // Takes row `y`, mirrored at the edges, in the place of row y - 5.
  void take(int y) {
    const float* row = from_.row(mirrored(y, from_.height()));
    const int left = area_.x0 - kDemosaicReach, right = area_.x1 + kDemosaicReach;
    const int whole0 = std::max(left, 0), whole1 = std::min(right, from_.width());
    const int skipped = (whole0 - left) / 2;
    split_(row + whole0, whole1 - whole0, half_line(y, 0) + skipped, half_line(y, 1) + skipped);
    const auto mirror = [&](int x) {
      const int seen = mirrored(x, from_.width()) - left;
      half_line(y, (x - left) & 1)[(x - left) >> 1] = half_line(y, seen & 1)[seen >> 1];
    };
    for (int x = left; x < whole0; ++x) mirror(x);
    for (int x = whole1; x < right; ++x) mirror(x);
  }

  // Where the area's first column is, or the one beside it.
  const float* of(int y, int odd) { return half_line(y, odd) + kDemosaicReach / 2; }

 private:
  static constexpr int kKept = 2 * kDemosaicReach + 1;

  float* half_line(int y, int odd) {
    return data_.data() + (2 * ((y - area_.y0 + kKept) % kKept) + odd) * half_;
  }

  View<const float> from_;
  Rect area_;
  Split split_;
  std::ptrdiff_t half_;
  std::vector<float> data_;
};

// `sigma` and `sigma_rgb` are empty where there are none.
void run(View<const float> mosaic, View<const float> sigma, const CfaPattern& cfa, Rect area,
         const std::array<View<float>, 3>& rgb, const std::array<View<float>, 3>& sigma_rgb,
         void (*row_kernel)(const DemosaicRow&)) {
  const bool has_sigma = sigma.height() > 0;
  Lines values(mosaic, area, HWY_DYNAMIC_DISPATCH(split_values));
  Lines variances(sigma, area, HWY_DYNAMIC_DISPATCH(split_variances));
  const auto take = [&](int y) {
    values.take(y);
    if (has_sigma) variances.take(y);
  };
  for (int y = area.y0 - kDemosaicReach; y < area.y0 + kDemosaicReach; ++y) take(y);
  for (int y = area.y0; y < area.y1; ++y) {
    take(y + kDemosaicReach);
    DemosaicRow row = {};
    for (int i = 0; i < 5; ++i) {
      for (int odd = 0; odd < 2; ++odd) {
        row.value[i][odd] = values.of(y - kDemosaicReach + i, odd);
        if (has_sigma) row.variance[i][odd] = variances.of(y - kDemosaicReach + i, odd);
      }
    }
    for (std::size_t c = 0; c < 3; ++c) {
      row.rgb[c] = rgb[c].row(y - area.y0);
      if (has_sigma) row.sigma[c] = sigma_rgb[c].row(y - area.y0);
    }
    row.width = static_cast<std::size_t>(area.width());
    row.green_is_odd = cfa.channel_at(1, y) == 1;
    row.red_row = cfa.channel_at(row.green_is_odd ? 0 : 1, y) == 0;
    row_kernel(row);
  }
}

}  // namespace

void demosaic(View<const float> mosaic, const CfaPattern& cfa, Rect area,
              const std::array<View<float>, 3>& rgb) {
  run(mosaic, {}, cfa, area, rgb, {}, HWY_DYNAMIC_DISPATCH(demosaic_values));
}

void demosaic(View<const float> mosaic, View<const float> sigma, const CfaPattern& cfa, Rect area,
              const std::array<View<float>, 3>& rgb, const std::array<View<float>, 3>& sigma_rgb) {
  run(mosaic, sigma, cfa, area, rgb, sigma_rgb, HWY_DYNAMIC_DISPATCH(demosaic_with_sigma));
}

}  // namespace weft::solver
#endif
