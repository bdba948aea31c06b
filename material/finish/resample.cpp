// SPDX-License-Identifier: Apache-2.0
#include "material/finish/resample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/base/parallel.h"
#include "core/base/vec.h"
#include "core/solve/solve_record.h"
#include "material/cubic.h"

namespace weft::material {
namespace {

constexpr int kMostStretch = 16, kMostTaps = 4 * kMostStretch + 2;
constexpr int kAzimuth = 2;  ///< plane of the lobe's direction
constexpr float kNoSigma = 180;

// Old pixels that a new one is made of, along one axis; outside the picture there are none.
struct Span {
  int first = 0, count = 0;
  double all = 0;  ///< sizes of the weights, those outside too
  std::array<double, kMostTaps> weight;

  Span(double at, double stretch, int size) {
    const int from = static_cast<int>(std::ceil(at - 2 * stretch)),
              to = static_cast<int>(std::floor(at + 2 * stretch));
    first = std::clamp(from, 0, size);
    for (int i = from; i <= to; ++i) {
      const double w = cubic_weight((i - at) / stretch);
      all += std::abs(w);
      if (i >= first && i < size) weight[static_cast<std::size_t>(count++)] = w;
    }
  }
};

// Weighted sums of every map over the solved pixels around a place.
struct Sums {
  double valid = 0, weight = 0, weight_squares = 0, sigma = 0, opacity = 0, opacity_weight = 0;
  std::array<double, 2> slope = {};
  std::array<double, 3> albedo = {};
};

Sums sums_at(const Surface& surface, const Span& across, const Span& down) {
  Sums sums;
  const int bands = surface.albedo.planes();
  for (int j = 0; j < down.count; ++j) {
    const int y = down.first + j;
    for (int i = 0; i < across.count; ++i) {
      const int x = across.first + i;
      const double w = across.weight[static_cast<std::size_t>(i)] * down.weight[static_cast<std::size_t>(j)];
      if (!surface.opacity.empty()) {
        sums.opacity += w * static_cast<double>(surface.opacity(x, y));
        sums.opacity_weight += w;
      }
      if ((surface.status(x, y) & kNoSolution) != 0) continue;
      sums.valid += std::abs(w);
      sums.weight += w;
      const double sigma = static_cast<double>(surface.sigma_deg(x, y));
      sums.weight_squares += w * w;
      sums.sigma += w * w * sigma * sigma;
      for (int p = 0; p < 2; ++p)
        sums.slope[static_cast<std::size_t>(p)] += w * static_cast<double>(surface.slope(x, y, p));
      for (int p = 0; p < bands; ++p)
        sums.albedo[static_cast<std::size_t>(p)] += w * static_cast<double>(surface.albedo(x, y, p));
    }
  }
  return sums;
}

// How the old surface lies under one new pixel.
struct Mapping {
  Lookup::Place place;
  double column = 0, row = 0;  ///< of the old picture
  double stretch_across = 1, stretch_down = 1;
};

Mapping mapping_at(const Lookup& lookup, Size old, int x, int y) {
  Mapping m;
  m.place = lookup.at(x, y);
  m.column = m.place.at.x + (old.width - 1) / 2.0;
  m.row = (old.height - 1) / 2.0 - m.place.at.y;
  const auto span = [](double a, double b) {
    return std::clamp(std::hypot(a, b), 1.0, double{kMostStretch});
  };
  m.stretch_across = span(m.place.by_column.x, m.place.by_row.x);
  m.stretch_down = span(m.place.by_column.y, m.place.by_row.y);
  return m;
}

// The direction that an old one has among new columns and rows.
float turned_azimuth(double azimuth_deg, const Lookup::Place& place) {
  const Vec2 way = {std::cos(radians(azimuth_deg)), std::sin(radians(azimuth_deg))};
  const double determinant = cross(place.by_column, place.by_row);
  const double columns = cross(way, place.by_row) / determinant,
               rows = cross(place.by_column, way) / determinant;
  const double turned = degrees(std::atan2(-rows, columns));
  return static_cast<float>(turned < 0 ? turned + 180 : turned >= 180 ? turned - 180 : turned);
}

void take_nearest(const Surface& surface, const Mapping& m, bool is_solved, int x, int y, Surface& out) {
  const int i = std::clamp(static_cast<int>(std::lround(m.column)), 0, surface.size().width - 1),
            j = std::clamp(static_cast<int>(std::lround(m.row)), 0, surface.size().height - 1);
  const int bits = surface.status(i, j);
  out.status(x, y) = static_cast<std::uint16_t>(is_solved ? bits & ~kNoSolution : bits | kNoSolution);
  if (surface.lobe.empty()) return;
  for (int p = 0; p < surface.lobe.planes(); ++p) out.lobe(x, y, p) = surface.lobe(i, j, p);
  out.lobe(x, y, kAzimuth) = turned_azimuth(static_cast<double>(surface.lobe(i, j, kAzimuth)), m.place);
}

void resample_pixel(const Surface& surface, const Mapping& m, Vec2 per_mm, int x, int y, Surface& out) {
  const Span across(m.column, m.stretch_across, surface.size().width),
      down(m.row, m.stretch_down, surface.size().height);
  const Sums sums = sums_at(surface, across, down);
  // Where most of what is positive is missing, the rest would be divided by next to nothing.
  const double all = across.all * down.all;
  const bool is_solved = sums.valid > 0.5 * all && sums.weight > 0.25 * all;
  take_nearest(surface, m, is_solved, x, y, out);
  if (!surface.opacity.empty() && sums.opacity_weight > 0.25 * all)
    out.opacity(x, y) = static_cast<float>(std::clamp(sums.opacity / sums.opacity_weight, 0.0, 1.0));
  out.sigma_deg(x, y) =
      is_solved ? static_cast<float>(std::sqrt(sums.sigma / sums.weight_squares)) : kNoSigma;
  if (!is_solved) return;
  const Vec2 slope = (1 / sums.weight) * Vec2{sums.slope[0], sums.slope[1]};
  out.slope(x, y, 0) = static_cast<float>(per_mm.x * dot(slope, m.place.by_column));
  out.slope(x, y, 1) = static_cast<float>(-per_mm.y * dot(slope, m.place.by_row));  // rows run down
  for (int p = 0; p < surface.albedo.planes(); ++p)
    out.albedo(x, y, p) =
        static_cast<float>(std::max(sums.albedo[static_cast<std::size_t>(p)] / sums.weight, 0.0));
}

}  // namespace

Surface resampled(const Surface& surface, const Lookup& lookup, double mm_per_column, double mm_per_row,
                  int threads) {
  const Size size = lookup.grid();
  Surface out;
  out.mm_per_pixel = std::sqrt(mm_per_column * mm_per_row);
  out.slope = Image<float>(size, 2);
  out.albedo = Image<float>(size, surface.albedo.planes());
  out.sigma_deg = Image<float>(size);
  out.status = Image<std::uint16_t>(size);
  if (!surface.opacity.empty()) out.opacity = Image<float>(size);
  if (!surface.lobe.empty()) out.lobe = Image<float>(size, surface.lobe.planes());
  const Vec2 per_mm = {surface.mm_per_pixel / mm_per_column, surface.mm_per_pixel / mm_per_row};
  parallel_for(static_cast<std::size_t>(size.height), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size.width; ++x)
      resample_pixel(surface, mapping_at(lookup, surface.size(), x, y), per_mm, x, y, out);
  });
  return out;
}

}  // namespace weft::material
