// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "material/lattice/search.h"

namespace weft::material {
namespace {

constexpr int kMostRepeats = 16;
// Tones of yarns that do not repeat reach 0.4 somewhere among so many lags.
constexpr double kLeastLevel = 0.5;
using RepeatValues = std::map<std::pair<int, int>, double>;

// Correlations of the luminance at whole repeats of the weave.
RepeatValues correlations_at_repeats(const Cell& cell, const Correlation& luminance) {
  RepeatValues values;
  for (int j = 0; j <= kMostRepeats; ++j) {
    for (int i = j == 0 ? 1 : -kMostRepeats; i <= kMostRepeats; ++i) {
      const Vec2 lag = cell.at(i, j);
      if (length(lag) > 0.9 * luminance.reach()) continue;
      const auto peak = luminance.peak_near(lag, 3);
      const double value = peak ? peak->value : luminance.at(lag).value_or(0);
      values[{i, j}] = values[{-i, -j}] = value;
    }
  }
  return values;
}

// Away from the yarns' directions: along a yarn its own tone repeats everywhere.
RepeatValues without_yarns(RepeatValues values, const Cell& cell, const Cell& along) {
  std::erase_if(values, [&](const auto& each) {
    const Vec2 lag = cell.at(each.first.first, each.first.second);
    const auto lies_along = [&](Vec2 yarn) { return std::abs(cross(lag, yarn)) < 0.5 * cell.area(); };
    return lies_along(along.a) || lies_along(along.b);
  });
  return values;
}

double level_of(const RepeatValues& values) {
  constexpr std::size_t kStrongest = 6;
  std::vector<double> sorted;
  for (const auto& [place, value] : values) sorted.push_back(value);
  if (sorted.size() < kStrongest) return 0;
  std::ranges::sort(sorted, std::greater());
  return std::accumulate(sorted.begin(), sorted.begin() + kStrongest, 0.0) / kStrongest;
}

bool holds(const Sublattice& s, const RepeatValues& values, double level) {
  constexpr int kFewest = 4;
  double sum = 0, least = 1;
  int count = 0;
  for (int j = -2; j <= 2; ++j) {
    for (int i = -2; i <= 2; ++i) {
      const auto found = values.find({i * s.across + j * s.shift, j * s.down});
      if (found == values.end()) continue;
      sum += found->second;
      least = std::min(least, found->second);
      ++count;
    }
  }
  return count >= kFewest && sum > 0.92 * level * count && least > 0.75 * level;
}

}  // namespace

std::optional<Sublattice> colour_sublattice(const Cell& cell, const Cell& along,
                                            const Correlation& luminance) {
  const RepeatValues values = without_yarns(correlations_at_repeats(cell, luminance), cell, along);
  const double level = level_of(values);
  if (level < kLeastLevel) return std::nullopt;
  for (int index = 1; index <= kMostRepeats * kMostRepeats; ++index) {
    for (int across = 1; across <= std::min(index, kMostRepeats); ++across) {
      if (index % across != 0 || index / across > kMostRepeats) continue;
      for (int shift = 0; shift < across; ++shift) {
        const Sublattice sublattice = {across, shift, index / across};
        if (holds(sublattice, values, level)) return sublattice;
      }
    }
  }
  return std::nullopt;
}

}  // namespace weft::material
