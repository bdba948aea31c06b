// SPDX-License-Identifier: Apache-2.0
#include "core/rig/reading_stop.h"

#include <algorithm>
#include <cstddef>

#include "core/rig/radiometry.h"

namespace weft {
namespace {

constexpr std::int64_t kFewest = 100;      // samples of all photographs
constexpr std::int64_t kFewestInOne = 20;  // of a photograph, for it to count
constexpr double kBelow = 0.8;             // of the highest level
constexpr double kAbove = 0.01;            // of the pile: that may lie above it
constexpr std::int64_t kPile = 3;          // times as many as elsewhere
constexpr double kNearBlack = 0.05;        // of the way from black to white
constexpr std::int64_t kMostPixels = 4'000'000;
constexpr StopRules kOneCountOfOne = {.fewest = 1};

/// Samples of levels [from, to], both of the joined range.
class LevelSums {
 public:
  explicit LevelSums(const std::vector<std::int64_t>& levels) : before_(levels.size() + 1) {
    for (std::size_t i = 0; i < levels.size(); ++i) before_[i + 1] = before_[i] + levels[i];
  }
  std::int64_t of(std::ptrdiff_t from, std::ptrdiff_t to) const {
    if (to < from || to < 0) return 0;
    return before_[static_cast<std::size_t>(to) + 1] -
           before_[static_cast<std::size_t>(std::max<std::ptrdiff_t>(from, 0))];
  }
  std::ptrdiff_t size() const { return static_cast<std::ptrdiff_t>(before_.size()) - 1; }

 private:
  std::vector<std::int64_t> before_;
};

std::uint32_t highest_of(const TopTally& tally) {
  return tally.counts.empty() ? 0 : tally.first + static_cast<std::uint32_t>(tally.counts.size()) - 1;
}

std::int64_t held(const TopTally& tally, std::uint32_t from, std::uint32_t to) {
  std::int64_t sum = 0;
  for (std::uint32_t level = std::max(from, tally.first); level <= to && level <= highest_of(tally); ++level)
    sum += tally.counts[level - tally.first];
  return sum;
}

/// The last level of the pile of this width, if there is one.
std::optional<std::ptrdiff_t> end_of_pile(const LevelSums& sums, std::ptrdiff_t width) {
  const std::ptrdiff_t last = sums.size() - 1;
  const double most_above = kAbove * static_cast<double>(sums.of(0, last));
  for (std::ptrdiff_t end = last; end >= width; --end) {
    const std::int64_t pile = sums.of(end - width + 1, end);
    const auto above = static_cast<double>(sums.of(end + 1, last));
    if (above > most_above) return {};
    if (pile < kFewest || sums.of(end, end) == 0 || above > kAbove * static_cast<double>(pile)) continue;
    std::int64_t elsewhere = 0;
    for (std::ptrdiff_t to = end - width; to >= 0; to -= width)
      elsewhere = std::max(elsewhere, sums.of(to - width + 1, to));
    if (pile > kPile * elsewhere) return end;
  }
  return {};
}

}  // namespace

std::optional<double> find_stop(std::span<const TopTally> photographs, const StopRules& rules) {
  std::uint32_t highest = 0;
  for (const TopTally& each : photographs) highest = std::max(highest, highest_of(each));
  if (highest == 0) return {};
  const auto first = static_cast<std::uint32_t>(kBelow * highest);
  std::vector<std::int64_t> levels(highest - first + 1);
  for (const TopTally& each : photographs)
    for (std::uint32_t level = std::max(first, each.first); level <= highest_of(each); ++level)
      levels[level - first] += each.counts[level - each.first];
  const LevelSums sums(levels);
  const auto widest = std::max<std::ptrdiff_t>(1, static_cast<std::ptrdiff_t>(rules.widest * highest));
  for (std::ptrdiff_t width = 1; width <= widest; width *= 2) {
    const std::optional<std::ptrdiff_t> end = end_of_pile(sums, width);
    if (!end) continue;
    std::ptrdiff_t begin = *end - width + 1;
    const std::int64_t pile = sums.of(begin, *end);
    while (begin < *end && 100 * sums.of(begin + 1, *end) > 99 * pile) ++begin;
    const auto from = first + static_cast<std::uint32_t>(begin),
               to = first + static_cast<std::uint32_t>(*end);
    int several = 0;
    for (const TopTally& each : photographs) {
      const std::int64_t in_one = held(each, from, to);
      if (static_cast<double>(in_one) > rules.most_of_one * static_cast<double>(each.samples)) return {};
      several += in_one >= kFewestInOne ? 1 : 0;
    }
    if (several >= rules.fewest) return from;
  }
  return {};
}

std::array<TopTally, 3> top_tallies(const RawFrame& frame) {
  const Size size = frame.counts.size();
  const int step = 2 * static_cast<int>(1 + size.pixels() / kMostPixels);
  std::array<std::vector<std::uint32_t>, 3> all;
  for (auto& each : all) each.resize(65536);
  std::array<TopTally, 3> tallies;
  for (int y = 0; y + 1 < size.height; y += step)
    for (int j = 0; j < 2; ++j) {
      const std::uint16_t* const row = frame.counts.plane().row(y + j);
      std::array<std::vector<std::uint32_t>*, 2> of_column;
      for (int i = 0; i < 2; ++i) {
        const auto channel = static_cast<std::size_t>(frame.cfa.channel_at(i, j));
        of_column[static_cast<std::size_t>(i)] = &all[channel];
        tallies[channel].samples += (size.width + 1 - i) / 2;
      }
      for (int x = 0; x < size.width; ++x) ++(*of_column[static_cast<std::size_t>(x & 1)])[row[x]];
    }
  for (std::size_t c = 0; c < 3; ++c) {
    std::size_t highest = all[c].size() - 1;
    while (highest > 0 && all[c][highest] == 0) --highest;
    tallies[c].first = static_cast<std::uint32_t>(kBelow * static_cast<double>(highest));
    tallies[c].counts.assign(all[c].begin() + tallies[c].first,
                             all[c].begin() + static_cast<std::ptrdiff_t>(highest) + 1);
  }
  return tallies;
}

std::array<float, 3> find_count_stops(std::span<const std::array<TopTally, 3>> mosaics,
                                      const RawFrame& like) {
  std::array<float, 3> stops = {};
  const double black = static_cast<double>(like.black[0][0]), white = static_cast<double>(like.white);
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<TopTally> of_channel;
    for (const auto& each : mosaics) of_channel.push_back(each[c]);
    const std::optional<double> stop = find_stop(of_channel, kCountsStop);
    if (stop && *stop > black + kNearBlack * (white - black)) stops[c] = static_cast<float>(*stop);
  }
  return stops;
}

std::array<float, 3> find_count_stops(const RawFrame& frame) {
  const std::array<TopTally, 3> tallies = top_tallies(frame);
  const double black = static_cast<double>(frame.black[0][0]);
  const double range = static_cast<double>(frame.white) - black;
  std::array<float, 3> stops = {};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::optional<double> stop = find_stop({&tallies[c], 1}, kOneCountOfOne);
    if (stop && *stop > black + kNearBlack * range && *stop < black + kSaturatedFrom * range)
      stops[c] = static_cast<float>(*stop);
  }
  return stops;
}

}  // namespace weft
