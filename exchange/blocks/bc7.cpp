// SPDX-License-Identifier: Apache-2.0
// Mode 6 of BC7: a line of 16 steps between two ends of 7 bits a channel and a low bit that channels share.
// A lane is a block. No operation is fused, so that every vector unit gives the same bytes.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "exchange/blocks/strip.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "exchange/blocks/bc7.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first.
#include <hwy/highway.h>

#ifndef WEFT_BC7_LANES
#define WEFT_BC7_LANES
namespace weft::exchange {

// What was found for as many blocks as a vector has lanes, 16 at most.
struct Bc7Lanes {
  static constexpr std::size_t kMost = 16;
  alignas(64) float end[2][4][kMost];  // 0 to 255, of the parity of `low`
  alignas(64) float low[2][kMost];
  alignas(64) float index[16][kMost];
  alignas(64) float is_flat[kMost];   // all texels round to the same colour
  alignas(64) float color[4][kMost];  // of the first texel
};

}  // namespace weft::exchange
#endif

HWY_BEFORE_NAMESPACE();
namespace weft::exchange {
namespace HWY_NAMESPACE {
namespace bc7 {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, Bc7Lanes::kMost>;
using V = hn::Vec<D>;

constexpr int kRefits = 2;
constexpr int kPowerSteps = 6;

HWY_INLINE V number(float value) {
  return hn::Set(D(), value);
}
HWY_INLINE V plus_product(V sum, V a, V b) {
  return hn::Add(sum, hn::Mul(a, b));
}
HWY_INLINE V rounded(V v) {
  return hn::Floor(hn::Add(v, number(0.5f)));
}
HWY_INLINE V clamped(V v, float least, float most) {
  return hn::Min(hn::Max(v, number(least)), number(most));
}

template <std::size_t kChannels>
struct Ends {
  V at[2][kChannels];
};

// Ends as a block can hold them, and what they cost.
template <std::size_t kChannels>
struct Candidate {
  Ends<kChannels> ends;
  V low[2];
  V error;

  HWY_INLINE void take_better(const Candidate& other) {
    const auto better = hn::Lt(other.error, error);
    for (int e = 0; e < 2; ++e) {
      low[e] = hn::IfThenElse(better, other.low[e], low[e]);
      for (std::size_t c = 0; c < kChannels; ++c) {
        ends.at[e][c] = hn::IfThenElse(better, other.ends.at[e][c], ends.at[e][c]);
      }
    }
    error = hn::IfThenElse(better, other.error, error);
  }
};

template <std::size_t kChannels>
class Blocks {
 public:
  HWY_INLINE Blocks(const StripRows& strip, std::size_t first) {
    for (std::size_t c = 0; c < kChannels; ++c) {
      for (std::size_t y = 0; y < 4; ++y) {
        const std::size_t i = 4 * y;
        hn::LoadInterleaved4(D(), strip.rows[c][y] + 4 * first, texel_[c][i], texel_[c][i + 1],
                             texel_[c][i + 2], texel_[c][i + 3]);
      }
    }
  }

  HWY_INLINE Candidate<kChannels> fitted() const {
    Ends<kChannels> ends = principal_ends();
    Candidate<kChannels> best;
    best.error = number(1e30f);
    for (int refit = 0; refit <= kRefits; ++refit) {
      Candidate<kChannels> found;
      found.error = number(1e30f);
      for (int lows = 0; lows < 4; ++lows) found.take_better(with_lows(ends, lows));
      best.take_better(found);
      V share[16];
      shares(found.ends, share);
      refitted(share, ends);
    }
    refine(best);
    refine(best);
    return best;
  }

  HWY_INLINE void store(const Candidate<kChannels>& best, Bc7Lanes& lanes) const {
    const D d;
    V index[16];
    best_indices(best.ends, index);
    for (int i = 0; i < 16; ++i) hn::Store(index[i], d, lanes.index[i]);
    for (int e = 0; e < 2; ++e) {
      hn::Store(best.low[e], d, lanes.low[e]);
      for (std::size_t c = 0; c < kChannels; ++c) hn::Store(best.ends.at[e][c], d, lanes.end[e][c]);
    }
    V spread = hn::Zero(d);
    for (std::size_t c = 0; c < kChannels; ++c) {
      const V first = rounded(texel_[c][0]);
      hn::Store(first, d, lanes.color[c]);
      for (int i = 1; i < 16; ++i) spread = hn::Max(spread, hn::AbsDiff(rounded(texel_[c][i]), first));
    }
    hn::Store(hn::IfThenElseZero(hn::Eq(spread, hn::Zero(d)), number(1)), d, lanes.is_flat);
  }

 private:
  // The ends of the texels along the axis of their largest spread, by power iteration.
  HWY_INLINE Ends<kChannels> principal_ends() const {
    V mean[kChannels], axis[kChannels];
    for (std::size_t c = 0; c < kChannels; ++c) {
      V sum = texel_[c][0];
      for (int i = 1; i < 16; ++i) sum = hn::Add(sum, texel_[c][i]);
      mean[c] = hn::Mul(sum, number(1.0f / 16));
    }
    find_axis(mean, axis);
    V square = number(1e-20f);
    for (std::size_t c = 0; c < kChannels; ++c) square = plus_product(square, axis[c], axis[c]);
    V least = hn::Zero(D()), most = hn::Zero(D());
    for (int i = 0; i < 16; ++i) {
      V along = hn::Zero(D());
      for (std::size_t c = 0; c < kChannels; ++c) {
        along = plus_product(along, hn::Sub(texel_[c][i], mean[c]), axis[c]);
      }
      along = hn::Div(along, square);
      least = hn::Min(least, along);
      most = hn::Max(most, along);
    }
    Ends<kChannels> ends;
    for (std::size_t c = 0; c < kChannels; ++c) {
      ends.at[0][c] = plus_product(mean[c], least, axis[c]);
      ends.at[1][c] = plus_product(mean[c], most, axis[c]);
    }
    return ends;
  }

  // Begins with the column of the covariance whose own variance is the largest: it is never at right angles
  // to the axis.
  HWY_INLINE void find_axis(const V (&mean)[kChannels], V (&axis)[kChannels]) const {
    V covariance[kChannels][kChannels];
    for (std::size_t a = 0; a < kChannels; ++a) {
      for (std::size_t b = a; b < kChannels; ++b) {
        V sum = hn::Zero(D());
        for (int i = 0; i < 16; ++i) {
          sum = plus_product(sum, hn::Sub(texel_[a][i], mean[a]), hn::Sub(texel_[b][i], mean[b]));
        }
        covariance[a][b] = covariance[b][a] = sum;
      }
    }
    V largest = number(-1);
    for (std::size_t a = 0; a < kChannels; ++a) {
      const auto larger = hn::Gt(covariance[a][a], largest);
      largest = hn::IfThenElse(larger, covariance[a][a], largest);
      for (std::size_t b = 0; b < kChannels; ++b) {
        axis[b] = a == 0 ? covariance[a][b] : hn::IfThenElse(larger, covariance[a][b], axis[b]);
      }
    }
    for (int step = 0; step < kPowerSteps; ++step) {
      V turned[kChannels];
      V length = number(1e-20f);
      for (std::size_t a = 0; a < kChannels; ++a) {
        turned[a] = hn::Mul(covariance[a][0], axis[0]);
        for (std::size_t b = 1; b < kChannels; ++b)
          turned[a] = plus_product(turned[a], covariance[a][b], axis[b]);
        length = hn::Max(length, hn::Abs(turned[a]));
      }
      for (std::size_t a = 0; a < kChannels; ++a) axis[a] = hn::Div(turned[a], length);
    }
  }

  // The nearest ends with low bits of 0 or 1: bit 0 of `lows` is that of the first end.
  HWY_INLINE Candidate<kChannels> with_lows(const Ends<kChannels>& ends, int lows) const {
    Candidate<kChannels> to;
    for (int e = 0; e < 2; ++e) {
      to.low[e] = number(static_cast<float>((lows >> e) & 1));
      for (std::size_t c = 0; c < kChannels; ++c) to.ends.at[e][c] = nearest(ends.at[e][c], to.low[e]);
    }
    to.error = error_of(to.ends);
    return to;
  }
  static HWY_INLINE V nearest(V value, V low) {
    const V high = clamped(rounded(hn::Mul(hn::Sub(value, low), number(0.5f))), 0, 127);
    return hn::Add(hn::Add(high, high), low);
  }

  // Weight, of 64, of an index from 0 to 15: 0, 4, 9, 13 ... 64.
  static HWY_INLINE V weight_of(V index) { return rounded(hn::Mul(index, number(64.0f / 15))); }
  // As hardware interpolates: ((64 - w) first + w second + 32) / 64, rounded down.
  static HWY_INLINE V step(V first, V difference, V share) {
    return hn::Floor(hn::Add(hn::Add(first, number(0.5f)), hn::Mul(share, difference)));
  }

  // Where texels are nearest to the line, in steps.
  struct Line {
    V difference[kChannels], scale;

    HWY_INLINE explicit Line(const Ends<kChannels>& ends) {
      V square = hn::Zero(D());
      for (std::size_t c = 0; c < kChannels; ++c) {
        difference[c] = hn::Sub(ends.at[1][c], ends.at[0][c]);
        square = plus_product(square, difference[c], difference[c]);
      }
      scale = hn::Div(number(15), hn::Max(square, number(1)));
    }
  };
  HWY_INLINE V index_on(const Line& line, const Ends<kChannels>& ends, int i) const {
    V along = hn::Zero(D());
    for (std::size_t c = 0; c < kChannels; ++c) {
      along = plus_product(along, hn::Sub(texel_[c][i], ends.at[0][c]), line.difference[c]);
    }
    return clamped(rounded(hn::Mul(along, line.scale)), 0, 15);
  }
  HWY_INLINE V error_at(const Line& line, const Ends<kChannels>& ends, V share, int i) const {
    V error = hn::Zero(D());
    for (std::size_t c = 0; c < kChannels; ++c) {
      const V off = hn::Sub(texel_[c][i], step(ends.at[0][c], line.difference[c], share));
      error = plus_product(error, off, off);
    }
    return error;
  }

  HWY_INLINE V error_of(const Ends<kChannels>& ends) const {
    const Line line(ends);
    V error = hn::Zero(D());
    for (int i = 0; i < 16; ++i) {
      const V share = hn::Mul(weight_of(index_on(line, ends, i)), number(1.0f / 64));
      error = hn::Add(error, error_at(line, ends, share, i));
    }
    return error;
  }

  // How far along the line the step of each texel is, 0 to 1.
  HWY_INLINE void shares(const Ends<kChannels>& ends, V (&share)[16]) const {
    const Line line(ends);
    for (int i = 0; i < 16; ++i) {
      share[i] = hn::Mul(weight_of(index_on(line, ends, i)), number(1.0f / 64));
    }
  }

  // Steps are rounded a channel, so the nearest one may be beside that of the line.
  HWY_INLINE void best_indices(const Ends<kChannels>& ends, V (&index)[16]) const {
    const Line line(ends);
    for (int i = 0; i < 16; ++i) {
      const V middle = index_on(line, ends, i);
      V least = number(1e30f);
      for (float beside : {0.0f, -1.0f, 1.0f}) {
        const V tried = clamped(hn::Add(middle, number(beside)), 0, 15);
        const V error = error_at(line, ends, hn::Mul(weight_of(tried), number(1.0f / 64)), i);
        const auto better = hn::Lt(error, least);
        index[i] = beside == 0 ? tried : hn::IfThenElse(better, tried, index[i]);
        least = hn::IfThenElse(better, error, least);
      }
    }
  }

  // The ends of least squares for given steps. Where all texels share a step the ends stay.
  HWY_INLINE void refitted(const V (&share)[16], Ends<kChannels>& ends) const {
    const V one = number(1);
    V aa = hn::Zero(D()), ab = aa, bb = aa, a_texel[kChannels], b_texel[kChannels];
    for (std::size_t c = 0; c < kChannels; ++c) a_texel[c] = b_texel[c] = hn::Zero(D());
    for (int i = 0; i < 16; ++i) {
      const V b = share[i], a = hn::Sub(one, b);
      aa = plus_product(aa, a, a);
      ab = plus_product(ab, a, b);
      bb = plus_product(bb, b, b);
      for (std::size_t c = 0; c < kChannels; ++c) {
        a_texel[c] = plus_product(a_texel[c], a, texel_[c][i]);
        b_texel[c] = plus_product(b_texel[c], b, texel_[c][i]);
      }
    }
    const V determinant = hn::Sub(hn::Mul(aa, bb), hn::Mul(ab, ab));
    const auto solvable = hn::Gt(determinant, number(1e-3f));
    const V inverse = hn::Div(one, hn::Max(determinant, number(1e-3f)));
    for (std::size_t c = 0; c < kChannels; ++c) {
      const V first = hn::Mul(hn::Sub(hn::Mul(a_texel[c], bb), hn::Mul(b_texel[c], ab)), inverse);
      const V second = hn::Mul(hn::Sub(hn::Mul(b_texel[c], aa), hn::Mul(a_texel[c], ab)), inverse);
      ends.at[0][c] = hn::IfThenElse(solvable, first, ends.at[0][c]);
      ends.at[1][c] = hn::IfThenElse(solvable, second, ends.at[1][c]);
    }
  }

  // Rounds the ends of least squares a channel together, by the steps as hardware makes them.
  HWY_INLINE void refine(Candidate<kChannels>& best) const {
    V share[16];
    shares(best.ends, share);
    Ends<kChannels> ends = best.ends;
    refitted(share, ends);
    Candidate<kChannels> found;
    found.error = number(1e30f);
    for (int lows = 0; lows < 4; ++lows) {
      Candidate<kChannels> tried;
      tried.error = hn::Zero(D());
      for (int e = 0; e < 2; ++e) tried.low[e] = number(static_cast<float>((lows >> e) & 1));
      for (std::size_t c = 0; c < kChannels; ++c) round_together(ends, share, c, tried);
      found.take_better(tried);
    }
    found.error = error_of(found.ends);
    best.take_better(found);
  }
  HWY_INLINE void round_together(const Ends<kChannels>& ends, const V (&share)[16], std::size_t c,
                                 Candidate<kChannels>& tried) const {
    V least = number(1e30f);
    for (float up : {0.0f, -2.0f, 2.0f}) {
      const V first = nearest(hn::Add(ends.at[0][c], number(up)), tried.low[0]);
      for (float on : {0.0f, -2.0f, 2.0f}) {
        const V second = nearest(hn::Add(ends.at[1][c], number(on)), tried.low[1]);
        const V difference = hn::Sub(second, first);
        V error = hn::Zero(D());
        for (int i = 0; i < 16; ++i) {
          const V off = hn::Sub(texel_[c][i], step(first, difference, share[i]));
          error = plus_product(error, off, off);
        }
        const auto better = hn::Lt(error, least);
        const bool is_first = up == 0 && on == 0;
        tried.ends.at[0][c] = is_first ? first : hn::IfThenElse(better, first, tried.ends.at[0][c]);
        tried.ends.at[1][c] = is_first ? second : hn::IfThenElse(better, second, tried.ends.at[1][c]);
        least = hn::IfThenElse(better, error, least);
      }
    }
    tried.error = hn::Add(tried.error, least);
  }

  V texel_[kChannels][16];
};

template <std::size_t kChannels>
HWY_INLINE std::size_t fit_lanes(const StripRows& strip, std::size_t first, Bc7Lanes& lanes) {
  const Blocks<kChannels> blocks(strip, first);
  blocks.store(blocks.fitted(), lanes);
  return hn::Lanes(D());
}

}  // namespace bc7

std::size_t fit_bc7_rgb(const StripRows& strip, std::size_t first, Bc7Lanes& lanes) {
  return bc7::fit_lanes<3>(strip, first, lanes);
}
std::size_t fit_bc7_rgba(const StripRows& strip, std::size_t first, Bc7Lanes& lanes) {
  return bc7::fit_lanes<4>(strip, first, lanes);
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::exchange
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace weft::exchange {

HWY_EXPORT(fit_bc7_rgb);
HWY_EXPORT(fit_bc7_rgba);

namespace {

// What the bits of a block of mode 6 say.
struct Mode6 {
  std::array<std::array<unsigned, 4>, 2> end = {};  // 7 bits
  std::array<unsigned, 2> low = {};
  std::array<unsigned, 16> index = {};
};

class BitWriter {
 public:
  explicit BitWriter(std::uint8_t* to) : to_(to) { std::fill(to_, to_ + 16, std::uint8_t{0}); }
  void put(unsigned value, unsigned bits) {
    for (unsigned i = 0; i < bits; ++i, ++at_) {
      to_[at_ / 8] = static_cast<std::uint8_t>(to_[at_ / 8] | (((value >> i) & 1U) << (at_ % 8)));
    }
  }

 private:
  std::uint8_t* to_;
  unsigned at_ = 0;
};

void write_block(Mode6 block, std::uint8_t* to) {
  // The first index has no bit for its upper half.
  if (block.index[0] >= 8) {
    std::swap(block.end[0], block.end[1]);
    std::swap(block.low[0], block.low[1]);
    for (unsigned& index : block.index) index = 15 - index;
  }
  BitWriter bits(to);
  bits.put(1U << 6, 7);
  for (std::size_t c = 0; c < 4; ++c) {
    for (const auto& end : block.end) bits.put(end[c], 7);
  }
  for (const unsigned low : block.low) bits.put(low, 1);
  bits.put(block.index[0], 3);
  for (std::size_t i = 1; i < 16; ++i) bits.put(block.index[i], 4);
}

// Step 7 lies 30 / 64 of the way between an even end and an odd one, and comes to any value from two ends
// near it: v from (v, v + 1) or (v - 1, v + 2) with the even end first, and from (v, v - 1) or (v + 1, v - 2)
// with the odd one first. The first does not reach 255, the second not 0.
Mode6 flat_block(const std::array<int, 4>& color, std::size_t channels) {
  const auto end = color.begin() + static_cast<std::ptrdiff_t>(channels);
  const bool has_0 = std::find(color.begin(), end, 0) != end;
  const bool is_odd_first = !has_0 && std::find(color.begin(), end, 255) != end;
  Mode6 block;
  block.low = is_odd_first ? std::array{1U, 0U} : std::array{0U, 1U};
  block.index.fill(7);
  for (std::size_t c = 0; c < 4; ++c) {
    const int v = c < channels ? color[c] : 255;
    const bool is_odd = v % 2 == 1;
    const int first = is_odd_first == is_odd ? v : is_odd_first ? v + 1 : v - 1;
    const int second = is_odd_first ? (is_odd ? v - 1 : v - 2) : (is_odd ? v + 2 : v + 1);
    block.end[0][c] = static_cast<unsigned>(std::clamp(first, 0, 255) / 2);
    block.end[1][c] = static_cast<unsigned>(std::clamp(second, 0, 255) / 2);
  }
  return block;
}

Mode6 block_of(const Bc7Lanes& lanes, std::size_t lane, std::size_t channels) {
  if (lanes.is_flat[lane] != 0) {
    std::array<int, 4> color = {};
    for (std::size_t c = 0; c < channels; ++c) color[c] = static_cast<int>(lanes.color[c][lane]);
    return flat_block(color, channels);
  }
  Mode6 block;
  for (std::size_t e = 0; e < 2; ++e) {
    block.low[e] = static_cast<unsigned>(lanes.low[e][lane]);
    block.end[e].fill(127);
    for (std::size_t c = 0; c < channels; ++c) {
      block.end[e][c] = static_cast<unsigned>(lanes.end[e][c][lane]) / 2;
    }
  }
  for (std::size_t i = 0; i < 16; ++i) block.index[i] = static_cast<unsigned>(lanes.index[i][lane]);
  return block;
}

}  // namespace

void encode_bc7(const StripRows& strip, int channels, std::uint8_t* blocks) {
  const auto fit = channels == 3 ? HWY_DYNAMIC_DISPATCH(fit_bc7_rgb) : HWY_DYNAMIC_DISPATCH(fit_bc7_rgba);
  Bc7Lanes lanes;
  for (std::size_t first = 0; first < strip.blocks;) {
    const std::size_t found = std::min(fit(strip, first, lanes), strip.blocks - first);
    for (std::size_t k = 0; k < found; ++k) {
      write_block(block_of(lanes, k, static_cast<std::size_t>(channels)), blocks + 16 * (first + k));
    }
    first += found;
  }
}

}  // namespace weft::exchange
#endif
