// SPDX-License-Identifier: Apache-2.0
#include "material/finish/join.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/solve/solve_record.h"

namespace weft::material {
namespace {

constexpr float kUnsolvedCost = 100;

// Columns and rows of a place `i` along an axis and `j` across it.
struct Pixel {
  int x, y;
};
Pixel pixel(Axis axis, int i, int j) {
  return axis == Axis::kX ? Pixel{i, j} : Pixel{j, i};
}

double deviation_of(const Image<float>& map, int plane) {
  double sum = 0, squares = 0;
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      const double value = static_cast<double>(map(x, y, plane));
      sum += value;
      squares += value * value;
    }
  }
  const double n = static_cast<double>(map.size().pixels()), mean = sum / n;
  return std::sqrt(std::max(squares / n - mean * mean, 1e-12));
}

float difference(const Surface& surface, Pixel a, Pixel b, const Scales& scales) {
  if (((surface.status(a.x, a.y) | surface.status(b.x, b.y)) & kNoSolution) != 0) return kUnsolvedCost;
  double sum = 0;
  const auto add = [&](const Image<float>& map, int plane, double scale) {
    const double d = static_cast<double>(map(a.x, a.y, plane) - map(b.x, b.y, plane)) / scale;
    sum += d * d;
  };
  for (int p = 0; p < 2; ++p) add(surface.slope, p, scales.slope[static_cast<std::size_t>(p)]);
  for (int p = 0; p < surface.albedo.planes(); ++p)
    add(surface.albedo, p, scales.albedo[static_cast<std::size_t>(p)] * std::sqrt(surface.albedo.planes()));
  return static_cast<float>(sum);
}

template <typename T>
void mix(const Image<T>& from, Pixel own, Pixel beyond, double weight, Pixel to, Image<T>& out) {
  for (int p = 0; p < from.planes(); ++p) {
    out(to.x, to.y, p) = static_cast<T>(weight * static_cast<double>(from(own.x, own.y, p)) +
                                        (1 - weight) * static_cast<double>(from(beyond.x, beyond.y, p)));
  }
}

template <typename T>
void take(const Image<T>& from, Pixel source, Pixel to, Image<T>& out) {
  for (int p = 0; p < from.planes(); ++p) out(to.x, to.y, p) = from(source.x, source.y, p);
}

Surface empty_like(const Surface& surface, Size size) {
  Surface out;
  out.mm_per_pixel = surface.mm_per_pixel;
  out.slope = Image<float>(size, 2);
  out.albedo = Image<float>(size, surface.albedo.planes());
  out.sigma_deg = Image<float>(size);
  out.status = Image<std::uint16_t>(size);
  if (!surface.opacity.empty()) out.opacity = Image<float>(size);
  if (!surface.lobe.empty()) out.lobe = Image<float>(size, surface.lobe.planes());
  return out;
}

void join_pixel(const Surface& surface, Pixel own, Pixel beyond, double weight, Pixel to, Surface& out) {
  const auto is_solved = [&](Pixel at) { return (surface.status(at.x, at.y) & kNoSolution) == 0; };
  // What one side does not know the other decides.
  if (is_solved(own) != is_solved(beyond) && weight > 0 && weight < 1) weight = is_solved(own) ? 1 : 0;
  mix(surface.slope, own, beyond, weight, to, out.slope);
  mix(surface.albedo, own, beyond, weight, to, out.albedo);
  mix(surface.sigma_deg, own, beyond, weight, to, out.sigma_deg);
  mix(surface.opacity, own, beyond, weight, to, out.opacity);
  const Pixel heavier = weight >= 0.5 ? own : beyond;
  take(surface.status, heavier, to, out.status);
  take(surface.lobe, heavier, to, out.lobe);
}

}  // namespace

Scales scales_of(const Surface& surface) {
  Scales scales;
  for (int p = 0; p < 2; ++p) scales.slope[static_cast<std::size_t>(p)] = deviation_of(surface.slope, p);
  for (int p = 0; p < surface.albedo.planes(); ++p)
    scales.albedo[static_cast<std::size_t>(p)] = deviation_of(surface.albedo, p);
  return scales;
}

Image<float> difference_in(const Surface& surface, const Overlap& overlap, int x0, int y0, int length,
                           int folded, const Scales& scales) {
  const int rows = folded > 0 ? std::min(length, folded) : length;
  Image<float> out({overlap.overlap, rows});
  const int i0 = overlap.axis == Axis::kX ? x0 : y0, j0 = overlap.axis == Axis::kX ? y0 : x0;
  for (int j = 0; j < length; ++j) {
    for (int i = 0; i < overlap.overlap; ++i) {
      out(i, j < rows ? j : j - rows) +=
          difference(surface, pixel(overlap.axis, i0 + i, j0 + j),
                     pixel(overlap.axis, i0 + i + overlap.period, j0 + j), scales);
    }
  }
  return out;
}

double own_weight(int place, int column, int feather) {
  const double t = std::clamp((place + 0.5 - column) / std::max(feather, 1) + 0.5, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

Surface joined(const Surface& surface, const Overlap& overlap, const Cut& cut, int feather) {
  const bool is_x = overlap.axis == Axis::kX;
  const int across = is_x ? surface.size().height : surface.size().width;
  Surface out = empty_like(surface, is_x ? Size{overlap.period, across} : Size{across, overlap.period});
  const int rows = static_cast<int>(cut.column.size());
  for (int y = 0; y < out.size().height; ++y) {
    for (int x = 0; x < out.size().width; ++x) {
      const int i = is_x ? x : y, j = is_x ? y : x;
      const Pixel own = {x, y};
      const bool has_two = i < overlap.overlap;
      const Pixel beyond = has_two ? pixel(overlap.axis, i + overlap.period, j) : own;
      const double weight =
          has_two ? own_weight(i, cut.column[static_cast<std::size_t>(j % rows)], feather) : 1;
      join_pixel(surface, own, beyond, weight, own, out);
    }
  }
  return out;
}

}  // namespace weft::material
