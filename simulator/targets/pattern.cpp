// SPDX-License-Identifier: Apache-2.0
#include "simulator/targets/pattern.h"

#include <algorithm>
#include <cmath>

namespace weft::simulator {
namespace {

constexpr double kPoint_mm = 1e-9;  // a narrower box is a point

/// The part of an interval that lies between the first and the last edge, by cells.
struct Cover {
  std::size_t first, last;
  double from, to;

  /// Share of cell i in it.
  double share(const std::vector<double>& edges, std::size_t i) const {
    if (first == last) return 1;
    return std::max(std::min(to, edges[i + 1]) - std::max(from, edges[i]), 0.0) / (to - from);
  }
};

std::size_t cell_of(const std::vector<double>& edges, double position) {
  const auto inner_begin = edges.begin() + 1;
  return static_cast<std::size_t>(std::upper_bound(inner_begin, edges.end() - 1, position) - inner_begin);
}

Cover cover(const std::vector<double>& edges, double centre, double width) {
  const double from = std::clamp(centre - width / 2, edges.front(), edges.back());
  const double to = std::clamp(centre + width / 2, edges.front(), edges.back());
  if (!(to - from > kPoint_mm)) {
    const std::size_t cell = cell_of(edges, centre);
    return {cell, cell, from, to};
  }
  return {cell_of(edges, from), cell_of(edges, to), from, to};
}

double covered(const std::vector<double>& edges, double centre, double width) {
  if (!(width > kPoint_mm)) return centre >= edges.front() && centre <= edges.back() ? 1 : 0;
  const double from = std::max(centre - width / 2, edges.front());
  const double to = std::min(centre + width / 2, edges.back());
  return to > from ? (to - from) / width : 0;
}

void sort_unique(std::vector<double>& edges) {
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
}

std::size_t index_of(const std::vector<double>& edges, double edge) {
  return static_cast<std::size_t>(std::lower_bound(edges.begin(), edges.end(), edge) - edges.begin());
}

}  // namespace

Pattern::Pattern(std::span<const Rectangle> rectangles) {
  for (const Rectangle& r : rectangles) {
    u_.insert(u_.end(), {r.u0_mm, r.u1_mm});
    v_.insert(v_.end(), {r.v0_mm, r.v1_mm});
  }
  sort_unique(u_);
  sort_unique(v_);
  const std::size_t columns = u_.size() - 1;
  inks_.resize(columns * (v_.size() - 1));
  for (const Rectangle& r : rectangles) {
    const std::size_t u1 = index_of(u_, r.u1_mm);
    const std::size_t v1 = index_of(v_, r.v1_mm);
    for (std::size_t j = index_of(v_, r.v0_mm); j < v1; ++j) {
      for (std::size_t i = index_of(u_, r.u0_mm); i < u1; ++i) inks_[j * columns + i] = r.ink;
    }
  }
}

int Pattern::ink_at(double u_mm, double v_mm) const {
  return inks_[cell_of(v_, v_mm) * (u_.size() - 1) + cell_of(u_, u_mm)];
}

double Pattern::coverage(const TargetSpot& spot) const {
  return covered(u_, spot.u_mm, spot.width_mm) * covered(v_, spot.v_mm, spot.height_mm);
}

Rgb Pattern::average(const TargetSpot& spot, std::span<const Rgb> albedo_of_ink) const {
  const Cover columns = cover(u_, spot.u_mm, spot.width_mm);
  const Cover rows = cover(v_, spot.v_mm, spot.height_mm);
  Rgb mean{};
  for (std::size_t j = rows.first; j <= rows.last; ++j) {
    for (std::size_t i = columns.first; i <= columns.last; ++i) {
      const auto ink = static_cast<std::size_t>(inks_[j * (u_.size() - 1) + i]);
      if (ink >= albedo_of_ink.size()) continue;
      const double share = rows.share(v_, j) * columns.share(u_, i);
      for (std::size_t c = 0; c < 3; ++c) mean[c] += share * albedo_of_ink[ink][c];
    }
  }
  return mean;
}

}  // namespace weft::simulator
