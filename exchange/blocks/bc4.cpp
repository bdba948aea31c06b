// SPDX-License-Identifier: Apache-2.0
// BC4: eight steps between two ends of 8 bits, or six and the values 0 and 255. A lane is a block. No
// operation is fused, so that every vector unit gives the same bytes.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "exchange/blocks/strip.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "exchange/blocks/bc4.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first.
#include <hwy/highway.h>

#ifndef WEFT_BC4_LANES
#define WEFT_BC4_LANES
namespace weft::exchange {

// What was found for as many blocks as a vector has lanes, 16 at most.
struct Bc4Lanes {
  static constexpr std::size_t kMost = 16;
  alignas(64) float end[2][kMost];    // as they stand in the block
  alignas(64) float code[16][kMost];  // of 3 bits
};

}  // namespace weft::exchange
#endif

HWY_BEFORE_NAMESPACE();
namespace weft::exchange {
namespace HWY_NAMESPACE {
namespace bc4 {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, Bc4Lanes::kMost>;
using V = hn::Vec<D>;

constexpr int kRounds = 2;
constexpr float kStarts = 2;  // half steps
constexpr float kReach = 2;   // of the search about the ends of least squares
constexpr float kRefused = 1e30f;

HWY_INLINE V number(float value) {
  return hn::Set(D(), value);
}
HWY_INLINE V plus_product(V sum, V a, V b) {
  return hn::Add(sum, hn::Mul(a, b));
}
HWY_INLINE V rounded(V v) {
  return hn::Floor(hn::Add(v, number(0.5f)));
}
HWY_INLINE V clamped(V v, float most) {
  return hn::Min(hn::Max(v, hn::Zero(D())), number(most));
}

// Two ends, the lower one first.
struct Range {
  V low, high, error;

  HWY_INLINE void take_better(const Range& other) {
    const auto better = hn::Lt(other.error, error);
    low = hn::IfThenElse(better, other.low, low);
    high = hn::IfThenElse(better, other.high, high);
    error = hn::IfThenElse(better, other.error, error);
  }
};

// `kLast` is 7, or 5 where a block has 0 and 255 as well.
template <int kLast>
class Steps {
 public:
  explicit HWY_INLINE Steps(const V (&texel)[16]) : texel_(texel) {}

  HWY_INLINE Range fitted() const {
    Range best = from_many_starts();
    for (int round = 0; round < kRounds; ++round) {
      const Range center = refitted(best);
      for (float up = -kReach; up <= kReach; ++up) {
        for (float on = -kReach; on <= kReach; ++on) {
          best.take_better(moved(center, number(up), number(on)));
        }
      }
    }
    return best;
  }

  HWY_INLINE V code(const Range& range, int i) const {
    const V step = step_of(range, i);
    const V last = number(kLast), zero = hn::Zero(D()), one = number(1);
    if (kLast == 7) {
      // From the upper end down: 1, 7, 6 ... 2, 0. Of equal ends the first.
      const V inner = hn::Sub(number(8), step);
      const V code = hn::IfThenElse(hn::Eq(step, zero), one, inner);
      return hn::IfThenZeroElse(hn::Or(hn::Eq(step, last), hn::Eq(range.low, range.high)), code);
    }
    const V inner = hn::IfThenElse(hn::Eq(step, last), one, hn::Add(step, one));
    const V code = hn::IfThenZeroElse(hn::Eq(step, zero), inner);
    const V between = error_of_step(range, i);
    const V with_zero = hn::IfThenElse(hn::Lt(error_of_zero(i), between), number(6), code);
    return hn::IfThenElse(hn::Lt(error_of_full(i), between), number(7), with_zero);
  }

 private:
  HWY_INLINE Range outermost() const {
    V low = number(255), high = hn::Zero(D());
    for (int i = 0; i < 16; ++i) {
      const V texel = rounded(texel_[i]);
      const auto inside = hn::And(hn::Gt(texel, hn::Zero(D())), hn::Lt(texel, number(255)));
      const bool all = kLast == 7;
      low = hn::Min(low, all ? texel : hn::IfThenElse(inside, texel, low));
      high = hn::Max(high, all ? texel : hn::IfThenElse(inside, texel, high));
    }
    Range range;
    range.low = hn::Min(low, high);
    range.high = high;
    return range;
  }

  HWY_INLINE Range moved(const Range& range, V up, V on) const {
    Range to;
    to.low = clamped(rounded(hn::Add(range.low, up)), 255);
    to.high = clamped(rounded(hn::Add(range.high, on)), 255);
    to.error = error_of(to);
    return to;
  }

  // Square errors have many minima: least squares from ends that lie up to a step inside or outside of the
  // outermost texels.
  HWY_INLINE Range from_many_starts() const {
    const Range outer = outermost();
    const V half = hn::Mul(hn::Sub(outer.high, outer.low), number(0.5f / kLast));
    Range best = moved(outer, hn::Zero(D()), hn::Zero(D()));
    for (float up = -kStarts; up <= kStarts; ++up) {
      for (float on = -kStarts; on <= kStarts; ++on) {
        const Range start = moved(outer, hn::Mul(half, number(up)), hn::Mul(half, number(on)));
        best.take_better(start);
        best.take_better(moved(refitted(start), hn::Zero(D()), hn::Zero(D())));
      }
    }
    return best;
  }

  HWY_INLINE V step_of(const Range& range, int i) const {
    const V scale = hn::Div(number(kLast), hn::Max(hn::Sub(range.high, range.low), number(1)));
    return clamped(rounded(hn::Mul(hn::Sub(texel_[i], range.low), scale)), kLast);
  }
  HWY_INLINE V error_of_step(const Range& range, int i) const {
    const V size = hn::Mul(hn::Sub(range.high, range.low), number(1.0f / kLast));
    const V off = hn::Sub(texel_[i], plus_product(range.low, size, step_of(range, i)));
    return hn::Mul(off, off);
  }
  HWY_INLINE V error_of_zero(int i) const { return hn::Mul(texel_[i], texel_[i]); }
  HWY_INLINE V error_of_full(int i) const {
    const V off = hn::Sub(texel_[i], number(255));
    return hn::Mul(off, off);
  }

  // Ends in the wrong order would say the other number of steps.
  HWY_INLINE V error_of(const Range& range) const {
    V error = hn::IfThenElseZero(hn::Gt(range.low, range.high), number(kRefused));
    for (int i = 0; i < 16; ++i) {
      V of_texel = error_of_step(range, i);
      if (kLast == 5) of_texel = hn::Min(of_texel, hn::Min(error_of_zero(i), error_of_full(i)));
      error = hn::Add(error, of_texel);
    }
    return error;
  }

  // Least squares for the steps that `range` gives. Where all texels share one the ends stay.
  HWY_INLINE Range refitted(const Range& range) const {
    const V zero = hn::Zero(D());
    V aa = zero, ab = zero, bb = zero, a_texel = zero, b_texel = zero;
    for (int i = 0; i < 16; ++i) {
      V b = hn::Mul(step_of(range, i), number(1.0f / kLast));
      V a = hn::Sub(number(1), b);
      if (kLast == 5) {
        const auto between = hn::Le(error_of_step(range, i), hn::Min(error_of_zero(i), error_of_full(i)));
        a = hn::IfThenElseZero(between, a);
        b = hn::IfThenElseZero(between, b);
      }
      aa = plus_product(aa, a, a);
      ab = plus_product(ab, a, b);
      bb = plus_product(bb, b, b);
      a_texel = plus_product(a_texel, a, texel_[i]);
      b_texel = plus_product(b_texel, b, texel_[i]);
    }
    const V determinant = hn::Sub(hn::Mul(aa, bb), hn::Mul(ab, ab));
    const auto solvable = hn::Gt(determinant, number(1e-3f));
    const V inverse = hn::Div(number(1), hn::Max(determinant, number(1e-3f)));
    const V low = hn::Mul(hn::Sub(hn::Mul(a_texel, bb), hn::Mul(b_texel, ab)), inverse);
    const V high = hn::Mul(hn::Sub(hn::Mul(b_texel, aa), hn::Mul(a_texel, ab)), inverse);
    Range to = range;
    to.low = hn::IfThenElse(solvable, clamped(rounded(low), 255), range.low);
    to.high = hn::IfThenElse(solvable, clamped(rounded(high), 255), range.high);
    return to;
  }

  const V (&texel_)[16];
};

HWY_INLINE bool reaches_the_limits(const V (&texel)[16]) {
  V least = texel[0], most = texel[0];
  for (int i = 1; i < 16; ++i) {
    least = hn::Min(least, texel[i]);
    most = hn::Max(most, texel[i]);
  }
  return !hn::AllFalse(D(), hn::Or(hn::Lt(least, number(0.5f)), hn::Ge(most, number(254.5f))));
}

std::size_t fit_lanes(const StripRows& strip, int channel, std::size_t first, Bc4Lanes& lanes) {
  const D d;
  V texel[16];
  for (std::size_t y = 0; y < 4; ++y) {
    const float* row = strip.rows[static_cast<std::size_t>(channel)][y] + 4 * first;
    hn::LoadInterleaved4(d, row, texel[4 * y], texel[4 * y + 1], texel[4 * y + 2], texel[4 * y + 3]);
  }
  const Steps<7> eight(texel);
  const Range best = eight.fitted();
  hn::Store(best.high, d, lanes.end[0]);
  hn::Store(best.low, d, lanes.end[1]);
  for (int i = 0; i < 16; ++i) hn::Store(eight.code(best, i), d, lanes.code[i]);
  if (!reaches_the_limits(texel)) return hn::Lanes(d);

  const Steps<5> six(texel);
  const Range other = six.fitted();
  const auto better = hn::Lt(other.error, best.error);
  hn::Store(hn::IfThenElse(better, other.low, best.high), d, lanes.end[0]);
  hn::Store(hn::IfThenElse(better, other.high, best.low), d, lanes.end[1]);
  for (int i = 0; i < 16; ++i) {
    const V code = hn::IfThenElse(better, six.code(other, i), hn::Load(d, lanes.code[i]));
    hn::Store(code, d, lanes.code[i]);
  }
  return hn::Lanes(d);
}

}  // namespace bc4

std::size_t fit_bc4(const StripRows& strip, int channel, std::size_t first, Bc4Lanes& lanes) {
  return bc4::fit_lanes(strip, channel, first, lanes);
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::exchange
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace weft::exchange {

HWY_EXPORT(fit_bc4);

void encode_bc4(const StripRows& strip, int channel, std::uint8_t* blocks, std::size_t step) {
  const auto fit = HWY_DYNAMIC_DISPATCH(fit_bc4);
  Bc4Lanes lanes;
  for (std::size_t first = 0; first < strip.blocks;) {
    const std::size_t found = std::min(fit(strip, channel, first, lanes), strip.blocks - first);
    for (std::size_t k = 0; k < found; ++k) {
      std::uint8_t* to = blocks + (first + k) * step;
      std::uint64_t codes = 0;
      for (std::size_t i = 16; i-- > 0;) codes = codes << 3 | static_cast<std::uint64_t>(lanes.code[i][k]);
      for (std::size_t e = 0; e < 2; ++e) to[e] = static_cast<std::uint8_t>(lanes.end[e][k]);
      for (std::size_t b = 0; b < 6; ++b) to[2 + b] = static_cast<std::uint8_t>(codes >> (8 * b));
    }
    first += found;
  }
}

}  // namespace weft::exchange
#endif
