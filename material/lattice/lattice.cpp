// SPDX-License-Identifier: Apache-2.0
#include "material/lattice/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/vec.h"
#include "material/lattice/correlation.h"
#include "material/lattice/search.h"
#include "material/usable.h"

namespace weft::material {
namespace {

// The two sets of yarns of a cloth.
struct Yarns {
  Cell along;                 ///< shortest repeats along the yarns, a the nearer one to +x
  double x_px = 0, y_px = 0;  ///< from yarn to yarn along `along.a`, and along `along.b`
  double share = 0;           ///< of the slopes' energy that goes on along either set
};

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

// Among all pairs of ways of the lattice that are nearly upright to each other the one along which most of
// the slopes' energy goes on. The mean of the correlation along a way is that energy's share (Wiener and
// Khinchin): a yarn goes on along itself, with its section, its crimp and whatever its thickness does, while
// along a diagonal hollows follow crests. Albedo has no vote, since prints and stripes go where they like.
// Diagonals and yarns of one cloth may be close, so a pair beyond 30 degrees from the frame has to be half
// as sure again.
//
// Several yarns may lie in one row of the lattice, as in ribs and baskets: there the correlation also stands
// high at whole parts of it.
//
// Nothing where no pair is as somebody said.
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

constexpr int kLeastSide = 64;
constexpr double kLeastRepeats = 3, kLeastYarn_px = 4;

Rect centre_crop(Size size, int side) {
  const int w = std::min(size.width, side), h = std::min(size.height, side);
  const int x0 = (size.width - w) / 2, y0 = (size.height - h) / 2;
  return {x0, y0, x0 + w, y0 + h};
}

// Whether slopes are alike again only farther away than a fifth of the frame.
LatticeKind kind_without_repeat(const Correlations& correlations) {
  constexpr double kAlike = 0.5;
  const Correlation mean = mean_of(std::array{&correlations.of[0], &correlations.of[1]});
  const auto peaks = mean.peaks(kAlike, 0.4 * mean.reach(), mean.reach());
  return peaks.empty() ? LatticeKind::kNone : LatticeKind::kFewRepeats;
}

double least_repeats_in(Size size, const Cell& cell) {
  const auto repeats = [&](Vec2 way) {
    return std::min(size.width / std::max(std::abs(way.x), 1e-9),
                    size.height / std::max(std::abs(way.y), 1e-9));
  };
  return std::min(repeats(cell.a), repeats(cell.b));
}

// Yarns that are hardly sampled put tops of the correlation where no larger weave has any, and hollows before
// them; plies of a yarn put their tops on its slope.
bool is_too_fine(const Lattice& lattice, const std::vector<const Correlation*>& slopes) {
  constexpr double kAlike = 0.55;
  const bool has_close_top = std::ranges::any_of(slopes, [&](const Correlation* each) {
    const auto peaks = each->peaks(0, 2, 0.68 * each->reach());
    return std::ranges::any_of(peaks, [&](const auto& peak) {
      return length(peak.lag) < kLeastYarn_px && peak.value > kAlike * peaks.front().value &&
             each->at(0.5 * peak.lag).value_or(0) < 0;
    });
  });
  return has_close_top || std::min(lattice.yarn_x_px, lattice.yarn_y_px) < kLeastYarn_px;
}

LatticeKind kind_of(const Lattice& lattice, const std::vector<const Correlation*>& slopes, Size frame) {
  if (least_repeats_in(frame, lattice.weave) < kLeastRepeats) return LatticeKind::kFewRepeats;
  return is_too_fine(lattice, slopes) ? LatticeKind::kTooFine : LatticeKind::kRepeat;
}

// The weakest slope's mean correlation at the nearest repeats.
double strength_of(const Cell& cell, const std::vector<const Correlation*>& slopes) {
  double least = 1;
  for (const Correlation* each : slopes) {
    const double sum = each->at(cell.a).value_or(0) + each->at(cell.b).value_or(0) +
                       each->at(cell.a + cell.b).value_or(0) + each->at(cell.a - cell.b).value_or(0);
    least = std::min(least, sum / 4);
  }
  return std::max(least, 0.0);
}

// The first whole multiple of a way that is a repeat of the cell too.
Vec2 repeat_along(Vec2 way, const Cell& cell) {
  constexpr int kMost = 256;
  for (int times = 1; times <= kMost; ++times) {
    const double i = cross(times * way, cell.b) / cell.area(), j = cross(cell.a, times * way) / cell.area();
    if (std::abs(i - std::round(i)) < 0.1 && std::abs(j - std::round(j)) < 0.1) return times * way;
  }
  return way;
}

void find_colours(const Correlation& luminance, const Cell& along, Lattice& lattice) {
  const auto sublattice = colour_sublattice(lattice.weave, along, luminance);
  lattice.colours_repeat = sublattice.has_value();
  lattice.colour = sublattice ? reduced(sublattice->of(lattice.weave)) : lattice.weave;
}

void state_yarns(const Yarns& yarns, Lattice& lattice) {
  const Cell& along = yarns.along;
  lattice.axes = {repeat_along(along.a, lattice.colour), repeat_along(along.b, lattice.colour)};
  lattice.yarn_x_px = yarns.x_px;
  lattice.yarn_y_px = yarns.y_px;
  lattice.yarn_share = yarns.share;
  lattice.turn_x_deg = degrees(std::atan2(along.a.y, along.a.x));
  lattice.turn_y_deg = degrees(std::atan2(-along.b.x, along.b.y));
}

void find_weave(const Cell& first, const Correlation& mean, const std::vector<const Correlation*>& slopes,
                Lattice& lattice) {
  RefinedCell cell = refined(first, mean);
  // A sublattice of index 8 may take three rounds of 2.
  for (int round = 0; round < 3; ++round) {
    const SublatticeTest test = test_sublattices(cell.cell, slopes);
    lattice.sublattice_t = std::max(lattice.sublattice_t, test.t);
    if (test.t <= kSureOfSublattice) break;
    cell = refined(reduced(test.best.of(cell.cell)), mean);
  }
  lattice.weave = reduced(cell.cell);
  lattice.residual_px = cell.residual_px;
  lattice.points = cell.points;
  lattice.strength = strength_of(lattice.weave, slopes);
}

Error not_as_said() {
  return {ErrorKind::kBadData, "the yarns do not lie as was said", "turn_deg, yarn_px",
          "no repeat of the cloth has yarns that are turned so and so far apart",
          "leave both out, and see what is found"};
}

}  // namespace

std::string_view name_of(LatticeKind kind) {
  switch (kind) {
    case LatticeKind::kRepeat:
      return "repeat";
    case LatticeKind::kOneWay:
      return "one-way";
    case LatticeKind::kFewRepeats:
      return "few-repeats";
    case LatticeKind::kTooFine:
      return "too-fine";
    case LatticeKind::kNone:
      break;
  }
  return "none";
}

std::string_view words_of(LatticeKind kind) {
  switch (kind) {
    case LatticeKind::kRepeat:
      return "two ways carry the cloth onto itself";
    case LatticeKind::kOneWay:
      return "the cloth repeats across its ribs only";
    case LatticeKind::kFewRepeats:
      return "fewer than three repeats lie in the frame";
    case LatticeKind::kTooFine:
      return "yarns are under four pixels wide";
    case LatticeKind::kNone:
      break;
  }
  return "no way carries the cloth onto itself";
}

Result<Lattice> find_lattice(const Surface& surface, const LatticeOptions& options) {
  if (auto usable = check_surface(surface, kLeastSide, "no repeat can be looked for"); !usable)
    return std::move(usable).error();
  const Rect crop = centre_crop(surface.size(), std::clamp(options.crop_px, kLeastSide, 4096));
  const Correlations correlations = correlate(surface, crop, options.threads);
  Lattice lattice;
  lattice.mm_per_pixel = surface.mm_per_pixel;
  std::vector<const Correlation*> slopes;
  std::vector<double> levels;
  for (std::size_t i = 0; i < 2; ++i) {
    if (!correlations.slope_repeats(static_cast<int>(i))) continue;
    slopes.push_back(&correlations.of[i]);
    levels.push_back(correlations.level[i]);
  }
  if (slopes.empty()) {
    lattice.kind = kind_without_repeat(correlations);
    return lattice;
  }
  if (const auto across = repeat_of_ribs(slopes, levels)) {
    lattice.kind = LatticeKind::kOneWay;
    lattice.weave.a = lattice.colour.a = lattice.axes.a = *across;
    return lattice;
  }
  const Correlation mean = mean_of(slopes);
  const auto first = first_cell(correlations, mean);
  if (!first) {
    lattice.kind = kind_without_repeat(correlations);
    return lattice;
  }
  find_weave(*first, mean, slopes, lattice);
  std::optional<Yarns> yarns = find_yarns(lattice.weave, correlations, options.said);
  const bool are_as_said = yarns.has_value();
  if (!are_as_said) yarns = find_yarns(lattice.weave, correlations, {});
  if (!yarns) return not_as_said();
  find_colours(correlations.of[2], yarns->along, lattice);
  state_yarns(*yarns, lattice);
  lattice.kind = kind_of(lattice, slopes, surface.size());
  if (!are_as_said && lattice.kind == LatticeKind::kRepeat) return not_as_said();
  return lattice;
}

}  // namespace weft::material
