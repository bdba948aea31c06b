// SPDX-License-Identifier: Apache-2.0
#include "material/lattice/search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "core/base/statistics.h"
#include "core/base/vec.h"

namespace weft::material {
namespace {

constexpr double kNearest_px = 3, kLeastArea_px = 9;
constexpr double kRounding = 0.02;  ///< of a correlation: what sampling at whole pixels may add, ...
constexpr double kOfPhases = 0.05;  ///< ... and over all points that lie alike among the pixels

int remainder_of(int i, int n) {
  return (i % n + n) % n;
}

// How high the multiples of two peaks stand against the strongest peaks, the least over the slopes.
std::optional<double> score_of(const Cell& cell, const Correlations& correlations) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t channel = 0; channel < 2; ++channel) {
    if (!correlations.slope_repeats(static_cast<int>(channel))) continue;
    const Correlation& correlation = correlations.of[channel];
    double sum = 0;
    int points = 0;
    for (int j = 0; j <= 2; ++j) {
      for (int i = j == 0 ? 1 : -2; i <= 2; ++i) {
        const Vec2 lag = cell.at(i, j);
        if (length(lag) > 0.9 * correlation.reach()) continue;
        sum += *correlation.at(lag);
        ++points;
      }
    }
    if (points < 4) return std::nullopt;
    least = std::min(least, sum / points / correlations.level[channel]);
  }
  return least;
}

struct Row {
  double i, j;
  Vec2 lag;
  double weight;
};

// Peaks of the correlation near the multiples of a cell, up to `reach` of them.
std::vector<Row> peaks_at_multiples(const Cell& cell, const Correlation& mean, int reach, double least) {
  const double radius = std::min(0.22 * std::min(length(cell.a), length(cell.b)), 6.0);
  std::vector<Row> rows;
  for (int j = 0; j <= reach; ++j) {
    for (int i = j == 0 ? 1 : -reach; i <= reach; ++i) {
      if (length(cell.at(i, j)) > 0.8 * mean.reach()) continue;
      const auto peak = mean.peak_near(cell.at(i, j), radius);
      if (peak && peak->value > least)
        rows.push_back({static_cast<double>(i), static_cast<double>(j), peak->lag, peak->value});
    }
  }
  return rows;
}

// Weighted least squares of lag = i a + j b.
std::optional<Cell> fitted(const std::vector<Row>& rows, const std::vector<double>& weights) {
  double ii = 0, ij = 0, jj = 0;
  Vec2 i_lag, j_lag;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Row& row = rows[k];
    ii += weights[k] * row.i * row.i;
    ij += weights[k] * row.i * row.j;
    jj += weights[k] * row.j * row.j;
    i_lag = i_lag + weights[k] * row.i * row.lag;
    j_lag = j_lag + weights[k] * row.j * row.lag;
  }
  const double determinant = ii * jj - ij * ij;
  if (!(determinant > 1e-9 * ii * jj)) return std::nullopt;
  return Cell{(1 / determinant) * (jj * i_lag - ij * j_lag), (1 / determinant) * (ii * j_lag - ij * i_lag)};
}

// Iteratively reweighted by Cauchy's function, its scale 1.5 medians of the distances.
void fit_robustly(const std::vector<Row>& rows, RefinedCell& refined) {
  std::vector<double> weights(rows.size()), distances(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) weights[k] = rows[k].weight;
  for (int round = 0; round < 4; ++round) {
    const auto cell = fitted(rows, weights);
    if (!cell) return;
    double squares = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      distances[k] = length(rows[k].lag - cell->at(rows[k].i, rows[k].j));
      squares += distances[k] * distances[k];
    }
    const double scale = std::max(0.02, 1.5 * median(distances));
    for (std::size_t k = 0; k < rows.size(); ++k)
      weights[k] = rows[k].weight / (1 + distances[k] * distances[k] / (scale * scale));
    refined = {*cell, std::sqrt(squares / static_cast<double>(rows.size())), static_cast<int>(rows.size())};
  }
}

// Mean correlations of the slopes at multiples of a cell. Those on its sides are left out: along a yarn its
// own thickness and tone repeat everywhere.
using Multiples = std::map<std::pair<int, int>, double>;

Multiples multiples_off_sides(const Cell& cell, std::span<const Correlation* const> slopes) {
  constexpr int kReach = 12;
  const double radius = std::min(0.2 * std::min(length(cell.a), length(cell.b)), 5.0);
  Multiples out;
  for (int j = 1; j <= kReach; ++j) {
    for (int i = -kReach; i <= kReach; ++i) {
      const Vec2 lag = cell.at(i, j);
      if (i == 0 || length(lag) > 0.7 * slopes[0]->reach()) continue;
      double sum = 0;
      for (const Correlation* each : slopes) {
        const auto peak = each->peak_near(lag, radius);
        sum += peak ? peak->value : each->at(lag).value_or(0);
      }
      out[{i, j}] = sum / static_cast<double>(slopes.size());
    }
  }
  return out;
}

// Student's t of how far points of a sublattice stand above the points beside them that are not of it. Beside
// each other, what falls with distance or along one direction is in both.
double t_above_neighbours(const Multiples& multiples, const Sublattice& sublattice) {
  constexpr int kFewest = 6;
  double n = 0, sum = 0, squares = 0;
  for (const auto& [place, value] : multiples) {
    if (!sublattice.has(place.first, place.second)) continue;
    double beside = 0;
    int count = 0;
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) {
        const auto other = multiples.find({place.first + i, place.second + j});
        if (other == multiples.end() || sublattice.has(place.first + i, place.second + j)) continue;
        beside += other->second;
        ++count;
      }
    }
    if (count == 0) continue;
    const double above = value - beside / count;
    n += 1;
    sum += above;
    squares += above * above;
  }
  if (n < kFewest) return 0;
  const double mean = sum / n,
               variance = std::max((squares - n * mean * mean) / (n - 1), kRounding * kRounding);
  return mean > kOfPhases ? mean / std::sqrt(variance / n) : 0;
}

}  // namespace

Cell reduced(Cell cell) {
  Vec2 a = cell.a, b = cell.b;
  for (int i = 0; i < 100; ++i) {
    if (dot(a, a) > dot(b, b)) std::swap(a, b);
    const double times = std::round(dot(a, b) / dot(a, a));
    if (times == 0) break;
    b = b - times * a;
  }
  const auto slant = [](Vec2 v) { return std::abs(v.x) / length(v); };
  if (slant(b) > slant(a)) std::swap(a, b);
  if (a.x < 0) a = -1 * a;
  if (cross(a, b) < 0) b = -1 * b;
  return {a, b};
}

bool Sublattice::has(int i, int j) const {
  return remainder_of(j, down) == 0 && remainder_of(i - shift * (j / down), across) == 0;
}

Cell Sublattice::of(const Cell& cell) const {
  return {cell.at(across, 0), cell.at(shift, down)};
}

std::optional<Cell> first_cell(const Correlations& correlations, const Correlation& mean) {
  constexpr std::size_t kMostPeaks = 90;
  constexpr double kOfBest = 0.94, kOfSmallest = 1.15;
  auto peaks = mean.peaks(0.05, kNearest_px, 0.68 * mean.reach());
  if (peaks.size() < 2) return std::nullopt;
  double top = 0;
  const std::size_t strong = std::min<std::size_t>(6, peaks.size());
  for (std::size_t i = 0; i < strong; ++i) top += peaks[i].value / static_cast<double>(strong);
  std::erase_if(peaks, [&](const auto& peak) { return peak.value < 0.35 * top; });
  std::ranges::stable_sort(peaks, {}, [](const auto& peak) { return length(peak.lag); });
  if (peaks.size() > kMostPeaks) peaks.resize(kMostPeaks);

  struct Candidate {
    Cell cell;
    double score, area;
  };
  std::vector<Candidate> candidates;
  for (std::size_t u = 0; u < peaks.size(); ++u) {
    for (std::size_t v = u + 1; v < peaks.size(); ++v) {
      const Cell cell = {peaks[u].lag, peaks[v].lag};
      const double area = std::abs(cell.area());
      if (area < 0.3 * length(cell.a) * length(cell.b) || area < kLeastArea_px) continue;
      if (const auto score = score_of(cell, correlations)) candidates.push_back({cell, *score, area});
    }
  }
  if (candidates.empty()) return std::nullopt;
  const double best = std::ranges::max_element(candidates, {}, &Candidate::score)->score;
  if (!(best > 0.3)) return std::nullopt;
  std::erase_if(candidates, [&](const Candidate& each) { return each.score < kOfBest * best; });
  const double smallest = std::ranges::min_element(candidates, {}, &Candidate::area)->area;
  std::erase_if(candidates, [&](const Candidate& each) { return each.area > kOfSmallest * smallest; });
  return reduced(std::ranges::max_element(candidates, {}, &Candidate::score)->cell);
}

RefinedCell refined(const Cell& cell, const Correlation& mean) {
  const auto peaks = mean.peaks(0, kNearest_px, 0.68 * mean.reach());
  const double least = peaks.empty() ? 0 : 0.3 * peaks.front().value;
  RefinedCell out = {cell, 0, 0};
  for (int reach = 1; reach <= 32; reach *= 2) {
    const auto rows = peaks_at_multiples(out.cell, mean, reach, least);
    if (rows.size() < 3) break;
    fit_robustly(rows, out);
  }
  return out;
}

SublatticeTest test_sublattices(const Cell& cell, std::span<const Correlation* const> slopes) {
  constexpr int kMostIndex = 8;
  const Multiples multiples = multiples_off_sides(cell, slopes);
  SublatticeTest test;
  for (int index = 2; index <= kMostIndex && test.t <= kSureOfSublattice; ++index) {
    for (int across = 1; across <= index; ++across) {
      if (index % across != 0) continue;
      for (int shift = 0; shift < across; ++shift) {
        const Sublattice sublattice = {across, shift, index / across};
        if (const double t = t_above_neighbours(multiples, sublattice); t > test.t) test = {sublattice, t};
      }
    }
  }
  return test;
}

}  // namespace weft::material
