// SPDX-License-Identifier: Apache-2.0
#include "material/lattice/yarns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "core/base/vec.h"

namespace weft::material {
namespace {

constexpr double kFarthest_deg = 20;  ///< of two sets of yarns from upright

double direction_deg(Vec2 way) {
  return degrees(std::atan2(way.y, way.x));
}

// From the nearer axis of the frame, -45 to 45.
double turn_deg(double direction_deg) {
  return std::remainder(direction_deg, 90.0);
}

double dear(double off, double as_much) {
  const double times = off / as_much;
  return 1 + times * times;
}

// A way of the lattice and what goes on along it.
struct Way {
  Vec2 step;
  double share;
};

// The mean correlation of the slopes along whole multiples of a way, begun at `from`: waves that do not go on
// along it cancel.
double mean_along(Vec2 step, Vec2 from, const Correlations& correlations) {
  const double far = 0.7 * correlations.of[0].reach();
  const int repeats = static_cast<int>(far / length(step)), samples = static_cast<int>(length(step)) + 1;
  if (repeats == 0) return 0;
  double sum = 0;
  for (int i = 1; i <= repeats * samples; ++i) {
    const Vec2 lag = from + (static_cast<double>(i) / samples) * step;
    for (std::size_t channel = 0; channel < 2; ++channel)
      sum += correlations.variance[channel] * correlations.of[channel].at(lag).value_or(0);
  }
  return sum / (repeats * samples) / (correlations.variance[0] + correlations.variance[1]);
}

std::vector<Way> ways_of(const Cell& cell, const Correlations& correlations) {
  constexpr int kMostMultiple = 8;
  std::vector<Way> ways;
  for (int j = 0; j <= kMostMultiple; ++j) {
    for (int i = j == 0 ? 1 : -kMostMultiple; i <= kMostMultiple; ++i) {
      if (std::gcd(i, j) != 1) continue;
      const Vec2 step = cell.at(i, j);
      ways.push_back({step, std::max(mean_along(step, {}, correlations), 0.0)});
    }
  }
  return ways;
}

// The nearer one to +x first, counterclockwise.
Cell upright(Vec2 a, Vec2 b) {
  const auto slant = [](Vec2 v) { return std::abs(v.x) / length(v); };
  if (slant(b) > slant(a)) std::swap(a, b);
  if (a.x < 0) a = -1 * a;
  if (cross(a, b) < 0) b = -1 * b;
  return {a, b};
}

// From row to row of the lattice along `along.a`, and along `along.b`: all rows along a yarn are as far
// apart.
std::array<double, 2> rows_px(const Cell& along, const Cell& cell) {
  return {cell.area() / length(along.b), cell.area() / length(along.a)};
}

// How sure it is that yarns lie so, as the share of the energy that speaks for it.
double sureness(const Cell& along, double share, const Cell& cell) {
  constexpr double kAsMuchAsShare_deg = 6, kOfLength = 0.1, kFarFromFrame_deg = 30, kFarSurer = 1.5;
  const double a_deg = direction_deg(along.a), b_deg = direction_deg(along.b) - 90;
  const double length_of_both = length(along.a) * length(along.b) / cell.area();
  const double sure = share / dear(std::remainder(a_deg - b_deg, 180.0), kAsMuchAsShare_deg) /
                      std::pow(length_of_both, kOfLength);
  return std::abs(turn_deg((a_deg + b_deg) / 2)) > kFarFromFrame_deg ? sure / kFarSurer : sure;
}

// Whole parts of a row that a yarn of the width that was said may be.
int parts_of(double row_px, double yarn_px) {
  return std::max(1, static_cast<int>(std::lround(row_px / yarn_px)));
}

// How much less sure a pair is for not being as it was said; none: not at all so.
std::optional<double> off_said(const Cell& along, const std::array<double, 2>& rows_px,
                               const SaidYarns& said) {
  constexpr double kFarthestTurn_deg = 5, kFarthestWithShear_deg = 10, kFarthestPart = 0.1, kLeastRow_px = 4;
  double off = 1;
  const bool is_said = said.turn_deg || said.x_px > 0 || said.y_px > 0;
  if (is_said && std::min(rows_px[0], rows_px[1]) < kLeastRow_px) return {};
  if (said.turn_deg) {
    const double turn = turn_deg(direction_deg(along.a) - *said.turn_deg),
                 with_shear = turn_deg(direction_deg(along.b) - *said.turn_deg);
    if (std::abs(turn) > kFarthestTurn_deg || std::abs(with_shear) > kFarthestWithShear_deg) return {};
    off *= dear(turn, 2);
  }
  for (const auto& [row_px, yarn_px] : {std::pair{rows_px[0], said.x_px}, {rows_px[1], said.y_px}}) {
    if (yarn_px == 0) continue;
    const double part = row_px / parts_of(row_px, yarn_px) / yarn_px - 1;
    if (std::abs(part) > kFarthestPart) return {};
    off *= dear(part, 0.02);
  }
  return off;
}

// How many yarns lie in a row, which is `row` across them: at as many parts of it the correlation stands
// nearly as high again.
int yarns_in_row(Vec2 along, Vec2 row, const Correlations& correlations) {
  constexpr int kMost = 8;
  constexpr double kNearly = 0.3;
  const double whole = mean_along(along, {}, correlations);
  for (int yarns = kMost; yarns > 1; --yarns) {
    double least = whole;
    for (int i = 1; i < yarns; ++i)
      least = std::min(least, mean_along(along, (static_cast<double>(i) / yarns) * row, correlations));
    if (least > kNearly * whole) return yarns;
  }
  return 1;
}

std::optional<Yarns> surest_pair(const std::vector<Way>& ways, const Cell& cell, const SaidYarns& said) {
  std::optional<Yarns> found;
  double surest = 0;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    for (std::size_t j = i + 1; j < ways.size(); ++j) {
      const double off_deg =
          std::remainder(direction_deg(ways[i].step) - direction_deg(ways[j].step) - 90, 180.0);
      if (std::abs(off_deg) > kFarthest_deg) continue;
      const Cell along = upright(ways[i].step, ways[j].step);
      const std::optional<double> off = off_said(along, rows_px(along, cell), said);
      if (!off) continue;
      const double share = ways[i].share + ways[j].share, sure = sureness(along, share, cell) / *off;
      if (!found || sure > surest) found = Yarns{.along = along, .share = share}, surest = sure;
    }
  }
  return found;
}

}  // namespace

std::optional<Yarns> find_yarns(const Cell& cell, const Correlations& correlations, const SaidYarns& said) {
  std::optional<Yarns> yarns = surest_pair(ways_of(cell, correlations), cell, said);
  if (!yarns) return yarns;
  const Vec2 a = yarns->along.a, b = yarns->along.b;
  const std::array<double, 2> rows = rows_px(yarns->along, cell);
  const double sine = cross(a, b) / length(a) / length(b);
  const auto yarns_in = [&](double row_px, double said_px, Vec2 along, Vec2 across) {
    if (said_px > 0) return parts_of(row_px, said_px);
    return yarns_in_row(along, (row_px / sine / length(across)) * across, correlations);
  };
  yarns->x_px = rows[0] / yarns_in(rows[0], said.x_px, b, a);
  yarns->y_px = rows[1] / yarns_in(rows[1], said.y_px, a, b);
  // Yarns interlace two by two at least; the legs of a knit's loops do not.
  const bool is_woven = length(a) > 1.5 * yarns->x_px && length(b) > 1.5 * yarns->y_px;
  if (!is_woven && said.x_px == 0) yarns->x_px = rows[0];
  if (!is_woven && said.y_px == 0) yarns->y_px = rows[1];
  return yarns;
}

}  // namespace weft::material
