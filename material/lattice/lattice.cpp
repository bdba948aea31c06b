// SPDX-License-Identifier: Apache-2.0
#include "material/lattice/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/base/vec.h"
#include "material/lattice/search.h"
#include "material/lattice/yarns.h"
#include "material/usable.h"

namespace weft::material {
namespace {

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

// Of the slopes at the nearest repeats.
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
