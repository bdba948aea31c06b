// SPDX-License-Identifier: Apache-2.0
#include "calibration/response/block_light.h"

#include "core/rig/radiometry.h"

namespace weft::calibration {
namespace {

struct Levels {
  std::array<std::array<double, 2>, 2> black;
  std::array<std::array<double, 2>, 2> full_from;
  double per_count;
};

Levels levels_of(const RawFrame& frame) {
  Levels levels = {};
  double mean = 0;
  for (std::size_t y = 0; y < 2; ++y) {
    for (std::size_t x = 0; x < 2; ++x) {
      const double black = static_cast<double>(frame.black[y][x]);
      levels.black[y][x] = black;
      levels.full_from[y][x] = saturated_from(frame, static_cast<int>(x), static_cast<int>(y));
      mean += black / 4;
    }
  }
  levels.per_count = 1 / (static_cast<double>(frame.white) - mean);
  return levels;
}

// Sums over one square, by channel.
struct Sums {
  double v = 0, v2 = 0, v3 = 0, used = 0, all = 0, full = 0, zero = 0, bright = 0;
};

Moments moments_of(const Sums& s) {
  if (s.full > 0 || s.zero > 0 || s.used == 0) return {};
  return {s.v / s.used, s.v2 / s.used, s.v3 / s.used, s.used};
}

}  // namespace

BlockLight block_light(const RawFrame& frame, View<const std::uint8_t> bad) {
  const Levels levels = levels_of(frame);
  const Size size = frame.counts.size();
  BlockLight light;
  light.frames = 1;
  light.grid = {size.width / kResponseBlock, size.height / kResponseBlock};
  std::array<Sums, 3> whole;
  for (int block_y = 0; block_y < light.grid.height; ++block_y) {
    for (int block_x = 0; block_x < light.grid.width; ++block_x) {
      std::array<Sums, 3> sums;
      for (int y = block_y * kResponseBlock; y < (block_y + 1) * kResponseBlock; ++y) {
        const std::uint16_t* row = frame.counts.plane().row(y);
        for (int x = block_x * kResponseBlock; x < (block_x + 1) * kResponseBlock; ++x) {
          if (!bad.empty() && bad(x, y) != 0) continue;
          const auto j = static_cast<std::size_t>(y & 1), i = static_cast<std::size_t>(x & 1);
          const double v = (row[x] - levels.black[j][i]) * levels.per_count;
          Sums& s = sums[static_cast<std::size_t>(frame.cfa.channel_at(x, y))];
          s.v += v;
          s.v2 += v * v;
          s.v3 += v * v * v;
          ++s.used;
          s.full += row[x] >= levels.full_from[j][i];
          s.zero += row[x] == 0;
        }
      }
      std::array<Moments, 3>& block = light.blocks.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) {
        block[c] = moments_of(sums[c]);
        whole[c].bright += sums[c].v;
        whole[c].all += sums[c].used;
        whole[c].full += sums[c].full;
        whole[c].zero += sums[c].zero;
      }
    }
  }
  const double all = whole[0].all + whole[1].all + whole[2].all;
  if (all > 0) light.zero_share = (whole[0].zero + whole[1].zero + whole[2].zero) / all;
  for (std::size_t c = 0; c < 3; ++c) {
    if (whole[c].all == 0) continue;
    light.full_share[c] = whole[c].full / whole[c].all;
    light.mean[c] = whole[c].bright / whole[c].all;
  }
  return light;
}

void join(BlockLight& sum, const BlockLight& frame) {
  if (sum.frames == 0) {
    sum = frame;
    return;
  }
  const double before = sum.frames, after = before + frame.frames;
  const auto mean = [&](double a, double b) { return (a * before + b * frame.frames) / after; };
  for (std::size_t i = 0; i < sum.blocks.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      Moments& a = sum.blocks[i][c];
      const Moments& b = frame.blocks[i][c];
      const bool both = a.photosites > 0 && b.photosites > 0;
      a = both ? Moments{mean(a.v, b.v), mean(a.v2, b.v2), mean(a.v3, b.v3), a.photosites + b.photosites}
               : Moments{};
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    sum.full_share[c] = mean(sum.full_share[c], frame.full_share[c]);
    sum.mean[c] = mean(sum.mean[c], frame.mean[c]);
  }
  sum.zero_share = mean(sum.zero_share, frame.zero_share);
  sum.frames += frame.frames;
}

Moments shifted(const Moments& m, double d) {
  return {m.v - d, m.v2 - 2 * d * m.v + d * d, m.v3 - 3 * d * m.v2 + 3 * d * d * m.v - d * d * d,
          m.photosites};
}

}  // namespace weft::calibration
