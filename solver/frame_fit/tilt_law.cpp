// SPDX-License-Identifier: Apache-2.0
#include "solver/frame_fit/tilt_law.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/base/statistics.h"

namespace weft::solver {
namespace {

constexpr std::size_t kAlike = 18;      // cells that lean alike, about
constexpr std::size_t kMostTilts = 16;  // an axis
constexpr std::size_t kFewestAlike = 8;
constexpr double kMuchLess = 0.5;  // of what is left without a highlight

// A cell that has a reading, by how it leans.
struct Leaning {
  std::size_t cell;
  double x, y;  // of its normal
  double albedo, light;
};

// Light of cells that lean alike, by their albedo.
struct Law {
  double slope = 0, highlight = 0;

  double error_of(const Leaning& cell) const { return cell.light - slope * cell.albedo - highlight; }
};

double median_of(std::span<const Leaning> cells, double Leaning::*what) {
  std::vector<double> all;
  for (const Leaning& each : cells) all.push_back(each.*what);
  return median(std::move(all));
}

Law without_highlight(std::span<const Leaning> alike) {
  std::vector<double> ratios;
  for (const Leaning& each : alike) ratios.push_back(each.light / each.albedo);
  return {median(std::move(ratios)), 0};
}

// Tukey's resistant line (Exploratory Data Analysis, 1977), through the medians of the darker and the lighter
// third.
Law with_highlight(std::span<Leaning> alike) {
  std::ranges::sort(alike, {}, &Leaning::albedo);
  const std::span<const Leaning> dark = alike.first(alike.size() / 3), light = alike.last(alike.size() / 3);
  const double from = median_of(dark, &Leaning::albedo), to = median_of(light, &Leaning::albedo);
  Law law;
  if (to > from)
    law.slope = (median_of(light, &Leaning::light) - median_of(dark, &Leaning::light)) / (to - from);
  std::vector<double> rest;
  for (const Leaning& each : alike) rest.push_back(law.error_of(each));
  law.highlight = median(std::move(rest));
  return law;
}

std::vector<std::vector<Leaning>> by_parts(const FrameCells& cells, const CellFit& fit, std::size_t k,
                                           Parts parts) {
  std::vector<std::vector<Leaning>> all(static_cast<std::size_t>(parts.across * parts.down));
  for (int y = 0; y < cells.rows; ++y) {
    for (int x = 0; x < cells.columns; ++x) {
      const std::size_t cell = cells.cell_at(x, y);
      const double albedo = length(fit.normal[cell]);
      const double value = static_cast<double>(cells.value[cell * cells.count + k]);
      if (!(albedo > 0) || !std::isfinite(value)) continue;
      const int part = y * parts.down / cells.rows * parts.across + x * parts.across / cells.columns;
      const Vec3 normal = normalized(fit.normal[cell]);
      all[static_cast<std::size_t>(part)].push_back({cell, normal.x, normal.y, albedo, value});
    }
  }
  return all;
}

// Calls what(group) for `count` groups of as many each, in the order of `axis`.
template <typename What>
void for_each_group(std::span<Leaning> all, double Leaning::*axis, std::size_t count, const What& what) {
  std::ranges::sort(all, [&](const Leaning& a, const Leaning& b) { return a.*axis < b.*axis; });
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = i * all.size() / count, to = (i + 1) * all.size() / count;
    what(all.subspan(from, to - from));
  }
}

double typical_size(const std::vector<float>& errors) {
  std::vector<float> sizes;
  for (const float error : errors) sizes.push_back(std::abs(error));
  return static_cast<double>(median(finite(std::move(sizes))));
}

}  // namespace

std::vector<float> errors_by_tilt(const FrameCells& cells, const CellFit& fit, std::size_t k, Parts parts) {
  std::vector<float> matt(cells.cells(), std::numeric_limits<float>::quiet_NaN()), shiny = matt;
  const auto take_off = [&](std::span<Leaning> alike) {
    if (alike.size() < kFewestAlike) return;
    const Law usual = without_highlight(alike), highlit = with_highlight(alike);
    for (const Leaning& each : alike) {
      const auto brightness = static_cast<double>(fit.brightness[each.cell]);
      matt[each.cell] = static_cast<float>(usual.error_of(each) / brightness);
      shiny[each.cell] = static_cast<float>(highlit.error_of(each) / brightness);
    }
  };
  for (std::vector<Leaning>& part : by_parts(cells, fit, k, parts)) {
    const double affordable = std::sqrt(static_cast<double>(part.size() / kAlike));
    const std::size_t tilts = std::clamp<std::size_t>(static_cast<std::size_t>(affordable), 1, kMostTilts);
    for_each_group(std::span(part), &Leaning::x, tilts,
                   [&](std::span<Leaning> group) { for_each_group(group, &Leaning::y, tilts, take_off); });
  }
  return typical_size(shiny) < kMuchLess * typical_size(matt) ? shiny : matt;
}

}  // namespace weft::solver
