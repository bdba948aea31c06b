// SPDX-License-Identifier: Apache-2.0
#include "core/rig/photosites.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>

#include "core/base/parallel.h"
#include "core/rig/radiometry.h"

namespace weft {
namespace {

constexpr int kCell = 2;  // columns and rows from a photosite to the next of its filter
constexpr int kStripRows = 64;

// The next place of the same filter, mirrored at the border.
int next(int i, int step, int size) {
  const int there = i + step >= 0 && i + step < size ? i + step : i - step;
  return there >= 0 && there < size ? there : i;
}

// body(left, right, x) for every column, with its neighbours' columns.
template <typename Body>
void for_each_column(int width, const Body& body) {
  const auto mirrored = [&](int x) { body(next(x, -kCell, width), next(x, kCell, width), x); };
  const int from = std::min(kCell, width), to = std::max(width - kCell, from);
  for (int x = 0; x < from; ++x) mirrored(x);
  for (int x = from; x < to; ++x) body(x - kCell, x + kCell, x);
  for (int x = to; x < width; ++x) mirrored(x);
}

// Gathers what body(y, found) finds in each row, in order of rows.
template <typename Body>
std::vector<Photosite> gather(int height, int threads, const Body& body) {
  const auto strips = static_cast<std::size_t>((height + kStripRows - 1) / kStripRows);
  std::vector<std::vector<Photosite>> found(strips);
  parallel_for(strips, threads, [&](std::size_t i, int) {
    const int y0 = static_cast<int>(i) * kStripRows;
    body(y0, std::min(y0 + kStripRows, height), found[i]);
  });
  std::vector<Photosite> all;
  for (const auto& of_strip : found) all.insert(all.end(), of_strip.begin(), of_strip.end());
  return all;
}

// Twice the count of each photosite of a row over the middle of its four neighbours.
void excess_of_row(View<const std::uint16_t> counts, int y, std::span<int> twice_excess) {
  const std::uint16_t* above = counts.row(next(y, -kCell, counts.height()));
  const std::uint16_t* row = counts.row(y);
  const std::uint16_t* below = counts.row(next(y, kCell, counts.height()));
  for_each_column(counts.width(), [&](int left, int right, int x) {
    const int a = above[x], b = below[x], l = row[left], r = row[right];
    const int middle_two = a + b + l + r - std::max({a, b, l, r}) - std::min({a, b, l, r});
    twice_excess[static_cast<std::size_t>(x)] = 2 * row[x] - middle_two;
  });
}

// Standard deviation of the excess over the frame, from a quarter of its rows.
double sigma_of_excess(View<const std::uint16_t> dark) {
  constexpr std::size_t kMost = 2 * 65536;
  std::vector<std::int64_t> histogram(kMost);
  std::vector<int> twice_excess(static_cast<std::size_t>(dark.width()));
  std::int64_t count = 0;
  for (int y = 0; y < dark.height(); ++y) {
    if (y % 8 > 1) continue;  // both rows of the filter cell
    excess_of_row(dark, y, twice_excess);
    for (const int e : twice_excess) ++histogram[std::min(static_cast<std::size_t>(std::abs(e)), kMost - 1)];
    count += dark.width();
  }
  std::int64_t below = 0;
  std::size_t median = 0;
  while (median < kMost - 1 && (below += histogram[median]) * 2 < count) ++median;
  constexpr double kSigmaOfMedian = 1.4826;  // of a normal distribution's absolute deviation
  return kSigmaOfMedian * static_cast<double>(median) / 2;
}

// Light of each photosite of a row, in counts, summed over the frames.
class LightOfRow {
 public:
  LightOfRow(std::span<const RawFrame> lit, const RawFrame* dark) : lit_(lit), dark_(dark) {}

  double one(std::size_t frame, int x, int y) const { return lit_[frame].counts(x, y) - dark_at(x, y); }

  void sum(int y, std::span<float> light) const {
    const int width = lit_.front().counts.width();
    std::fill(light.begin(), light.end(), 0.0f);
    for (const RawFrame& frame : lit_) {
      const std::uint16_t* row = frame.counts.plane().row(y);
      for (int x = 0; x < width; ++x) light[static_cast<std::size_t>(x)] += static_cast<float>(row[x]);
    }
    const auto frames = static_cast<float>(lit_.size());
    for (int x = 0; x < width; ++x) {
      light[static_cast<std::size_t>(x)] -= frames * static_cast<float>(dark_at(x, y));
    }
  }

 private:
  double dark_at(int x, int y) const {
    return dark_ != nullptr
               ? dark_->counts(x, y)
               : lit_.front().black[static_cast<std::size_t>(y & 1)][static_cast<std::size_t>(x & 1)];
  }

  std::span<const RawFrame> lit_;
  const RawFrame* dark_;
};

// Whether every frame whose darkest neighbour is bright, three at least, has the photosite near black.
bool is_dead(const LightOfRow& light, std::size_t frames, Size size, Photosite site, double bright_counts) {
  const auto [y, x] = site;
  const int above = next(y, -kCell, size.height), below = next(y, kCell, size.height);
  const int left = next(x, -kCell, size.width), right = next(x, kCell, size.width);
  int bright = 0;
  for (std::size_t k = 0; k < frames; ++k) {
    const double darkest = std::min(
        {light.one(k, x, above), light.one(k, x, below), light.one(k, left, y), light.one(k, right, y)});
    if (darkest < bright_counts) continue;
    if (light.one(k, x, y) >= kDeadBelow * darkest) return false;
    ++bright;
  }
  return bright >= 3;
}

// The neighbours that stand for a photosite, and by which share.
struct Replacement {
  struct Part {
    Photosite site;
    double share = 0;
  };
  std::array<Part, 4> parts = {};
  int count = 0;

  void apply(Photosite of, RawFrame& frame) const {
    if (count == 0) return;
    const double full_from = saturated_from(frame, of.x, of.y);
    double mean = 0;
    bool is_full = false;
    for (int i = 0; i < count; ++i) {
      const auto& [site, share] = parts[static_cast<std::size_t>(i)];
      const double there = frame.counts(site.x, site.y);
      mean += share * there;
      is_full = is_full || there >= full_from;
    }
    const double value = is_full ? std::ceil(static_cast<double>(frame.full_at(of.x, of.y))) : mean + 0.5;
    frame.counts(of.x, of.y) = static_cast<std::uint16_t>(std::clamp(value, 0.0, 65535.0));
  }
};

Replacement replacement_of(Photosite site, std::span<RawFrame* const> frames,
                           std::span<const Photosite> bad) {
  constexpr int kReach = 16;
  const auto [y, x] = site;
  const Size size = frames.empty() ? Size() : frames.front()->counts.size();
  const auto is_good = [&](Photosite p) {
    return p.x >= 0 && p.y >= 0 && p.x < size.width && p.y < size.height &&
           !std::binary_search(bad.begin(), bad.end(), p);
  };
  // 1 / squared difference of a pair: 0 where it is not whole.
  const auto weight_of = [&](Photosite a, Photosite b) {
    if (!is_good(a) || !is_good(b)) return 0.0;
    double difference = 1;
    for (const RawFrame* frame : frames) {
      difference += std::abs(frame->counts(a.x, a.y) - frame->counts(b.x, b.y));
    }
    return 1 / (difference * difference);
  };
  Replacement replacement;
  for (int r = kCell; r <= kReach && replacement.count == 0; r += kCell) {
    const std::array<Photosite, 4> near = {{{y, x - r}, {y, x + r}, {y - r, x}, {y + r, x}}};
    std::array<double, 2> weight = {weight_of(near[0], near[1]), weight_of(near[2], near[3])};
    const bool no_pair = weight[0] + weight[1] == 0;
    double sum = 0;
    for (std::size_t i = 0; i < near.size(); ++i) {
      const double w = no_pair ? 1 : weight[i / 2];
      if (!is_good(near[i]) || w == 0) continue;
      replacement.parts[static_cast<std::size_t>(replacement.count++)] = {near[i], w};
      sum += w;
    }
    for (int i = 0; i < replacement.count; ++i) replacement.parts[static_cast<std::size_t>(i)].share /= sum;
  }
  return replacement;
}

}  // namespace

std::vector<Photosite> hot_photosites(const RawFrame& dark, double read_noise_counts, int threads) {
  const View<const std::uint16_t> counts = dark.counts.plane();
  constexpr double kRounding = 0.29;  // of whole counts
  const double sigma = std::max({sigma_of_excess(counts), read_noise_counts, kRounding});
  const double range = static_cast<double>(dark.white) - static_cast<double>(dark.black[0][0]);
  const double hot_from = 2 * std::max(kHotFrom_sigmas * sigma, kHotFromShare * range);
  return gather(counts.height(), threads, [&](int y0, int y1, std::vector<Photosite>& found) {
    std::vector<int> twice_excess(static_cast<std::size_t>(counts.width()));
    for (int y = y0; y < y1; ++y) {
      excess_of_row(counts, y, twice_excess);
      for (int x = 0; x < counts.width(); ++x) {
        if (twice_excess[static_cast<std::size_t>(x)] > hot_from) found.push_back({y, x});
      }
    }
  });
}

std::vector<Photosite> dead_photosites(std::span<const RawFrame> lit, const RawFrame* dark,
                                       double read_noise_counts, int threads) {
  if (lit.size() < 3) return {};
  const Size size = lit.front().counts.size();
  const LightOfRow light(lit, dark);
  const double bright_counts = kBrightFrom_sigmas * std::max(read_noise_counts, 1.0);
  return gather(size.height, threads, [&](int y0, int y1, std::vector<Photosite>& found) {
    std::array<std::vector<float>, 2 * kCell + 1> rows;  // by row modulo their number
    const auto row_of = [&](int y) -> std::vector<float>& {
      return rows[static_cast<std::size_t>(y) % rows.size()];
    };
    for (auto& row : rows) row.resize(static_cast<std::size_t>(size.width));
    int summed = std::max(y0 - kCell, 0);
    for (int y = y0; y < y1; ++y) {
      for (; summed < std::min(y + kCell + 1, size.height); ++summed) light.sum(summed, row_of(summed));
      const float* above = row_of(next(y, -kCell, size.height)).data();
      const float* row = row_of(y).data();
      const float* below = row_of(next(y, kCell, size.height)).data();
      for_each_column(size.width, [&](int left, int right, int x) {
        // A dead photosite's sum is below twice that share, whatever the shots that are not bright add.
        const float darkest = std::min({above[x], below[x], row[left], row[right]});
        if (row[x] >= static_cast<float>(2 * kDeadBelow) * darkest || darkest < 3 * bright_counts) return;
        if (is_dead(light, lit.size(), size, {y, x}, bright_counts)) found.push_back({y, x});
      });
    }
  });
}

void replace_photosites(std::span<RawFrame* const> frames, std::span<const Photosite> bad, int threads) {
  std::vector<Replacement> replacements(bad.size());
  parallel_for(bad.size(), threads,
               [&](std::size_t i, int) { replacements[i] = replacement_of(bad[i], frames, bad); });
  parallel_for(frames.size(), threads, [&](std::size_t f, int) {
    for (std::size_t i = 0; i < bad.size(); ++i) replacements[i].apply(bad[i], *frames[f]);
  });
}

}  // namespace weft
