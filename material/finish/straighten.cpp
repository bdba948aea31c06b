// SPDX-License-Identifier: Apache-2.0
#include "material/finish/straighten.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "core/base/parallel.h"
#include "core/base/vec.h"
#include "core/solve/solve_record.h"
#include "material/cubic.h"
#include "material/usable.h"

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

// A surface on the grid of a lookup. `mm_per_column` and `mm_per_row` are the new grid's, for the slopes.
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

constexpr int kMostSide = 32768, kLookupStep = 8, kLeastSide = 64;
constexpr double kJoint_px = 48;  ///< what the ends of a tile need at least to be joined
const char* const kNotStraightened = "the cloth cannot be straightened";

Error not_straightened(ErrorKind kind, std::string why, std::string remedy) {
  return {kind, kNotStraightened, "straighten", std::move(why), std::move(remedy)};
}

// Columns and rows along the yarns, around the centre of the photographed cloth.
struct StraightGrid {
  Size size;
  int repeats_x = 0, repeats_y = 0;
  Size period_px;
  Vec2 by_column, by_row;  ///< old pixels, without pulls

  Vec2 lattice_place(double column, double row) const {
    return (column - (size.width - 1) / 2.0) * by_column + (row - (size.height - 1) / 2.0) * by_row;
  }
};

// Whether a rectangle of half sides `u` and `v` old pixels along the yarns lies in the frame.
bool lies_within(const Cell& axes, Size frame, double u, double v) {
  const Vec2 across = (u / length(axes.a)) * axes.a, up = (v / length(axes.b)) * axes.b;
  return std::abs(across.x) + std::abs(up.x) <= (frame.width - 1) / 2.0 &&
         std::abs(across.y) + std::abs(up.y) <= (frame.height - 1) / 2.0;
}

// The largest number for which `fits` holds, of those that hold up to some limit.
template <typename Fits>
double largest(double beyond, Fits&& fits) {
  double holds = 0;
  for (int i = 0; i < 50; ++i) {
    const double middle = (holds + beyond) / 2;
    (fits(middle) ? holds : beyond) = middle;
  }
  return holds;
}

// Half sides of a rectangle in the frame: the frame's proportions, then each side as long as it may be.
std::array<double, 2> widest(const Cell& axes, Size frame) {
  const double w = frame.width, h = frame.height;
  const double both = largest(2, [&](double k) { return lies_within(axes, frame, k * w, k * h); });
  const double u = largest(2 * w, [&](double k) { return lies_within(axes, frame, k, both * h); });
  const double v = largest(2 * h, [&](double k) { return lies_within(axes, frame, u, k); });
  return {u, v};
}

// The frame less what pulls at its border may reach beyond it.
Size frame_within(Size frame, const Displacement& displacement) {
  const Image<float>& field = displacement.field();
  double across = 0, down = 0;
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      if (x > 0 && y > 0 && x < field.width() - 1 && y < field.height() - 1) continue;
      across = std::max(across, std::abs(static_cast<double>(field(x, y, 0))));
      down = std::max(down, std::abs(static_cast<double>(field(x, y, 1))));
    }
  }
  return {std::max(1, frame.width - 2 * static_cast<int>(std::ceil(across))),
          std::max(1, frame.height - 2 * static_cast<int>(std::ceil(down)))};
}

Result<StraightGrid> straight_grid_of(const Surface& surface, const Lattice& lattice,
                                      const Displacement& displacement, const StraightenOptions& options) {
  const double mm = options.mm_per_pixel == 0 ? surface.mm_per_pixel : options.mm_per_pixel;
  if (!(mm > 0 && std::isfinite(mm)))
    return not_straightened(ErrorKind::kUsage, "mm_per_pixel is not above 0", "ask for a size above 0");
  if (options.repeats_x < 0 || options.repeats_y < 0)
    return not_straightened(ErrorKind::kUsage, "a number of repeats is below 0",
                            "ask for 1 repeat or more, or 0");
  const double scale = surface.mm_per_pixel / mm;
  const std::array<double, 2> half = widest(lattice.axes, frame_within(surface.size(), displacement));
  const std::array<double, 2> repeat = {scale * length(lattice.axes.a), scale * length(lattice.axes.b)};
  std::array<int, 2> size = {}, repeats = {options.repeats_x, options.repeats_y}, period = {};
  for (std::size_t i = 0; i < 2; ++i) {
    const double longest = 2 * scale * half[i] + 1;
    if (!(longest <= kMostSide)) {
      return not_straightened(ErrorKind::kUsage,
                              fmt::format("{:.4g} mm a pixel make {:.0f} pixels a side", mm, longest),
                              fmt::format("ask for a size that gives {} at most", kMostSide));
    }
    size[i] = static_cast<int>(longest);
    if (repeats[i] == 0) {
      const double for_joint = std::max(repeat[i], kJoint_px);
      repeats[i] = std::max(1, static_cast<int>((size[i] - for_joint) / repeat[i]));
    }
    const double pixels = std::max(1.0, std::round(repeats[i] * repeat[i]));
    if (!(pixels <= kMostSide)) {
      return not_straightened(ErrorKind::kUsage,
                              fmt::format("{} repeats are {:.0f} pixels", repeats[i], pixels),
                              "ask for fewer repeats");
    }
    period[i] = static_cast<int>(pixels);
  }
  StraightGrid grid = {{size[0], size[1]}, repeats[0], repeats[1], {period[0], period[1]}, {}, {}};
  grid.by_column = (static_cast<double>(grid.repeats_x) / grid.period_px.width) * lattice.axes.a;
  grid.by_row = (-static_cast<double>(grid.repeats_y) / grid.period_px.height) * lattice.axes.b;
  return grid;
}

// Places of x + d(x) = X: pulls are small against their own length, so few rounds do.
Lookup lookup_of(const StraightGrid& grid, const Displacement& displacement, int threads) {
  constexpr int kIterations = 6;
  Lookup lookup(grid.size, kLookupStep);
  parallel_for(static_cast<std::size_t>(lookup.nodes().height), threads, [&](std::size_t row, int) {
    const int j = static_cast<int>(row);
    for (int i = 0; i < lookup.nodes().width; ++i) {
      const Vec2 wanted = grid.lattice_place((i - 1) * kLookupStep, (j - 1) * kLookupStep);
      Vec2 place = wanted;
      for (int round = 0; round < kIterations; ++round) place = wanted - displacement.at(place);
      lookup.set(i, j, place);
    }
  });
  return lookup;
}

void state_pull(double mm_per_pixel, Straightened& out) {
  const Image<float>& field = out.displacement.field();
  double squares = 0;
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      const double pull = length({field(x, y, 0), field(x, y, 1)});
      squares += pull * pull;
      out.largest_pull_mm = std::max(out.largest_pull_mm, mm_per_pixel * pull);
    }
  }
  if (!field.empty())
    out.rms_pull_mm = mm_per_pixel * std::sqrt(squares / static_cast<double>(field.size().pixels()));
}

}  // namespace

bool is_to_be_asked(const Lattice& lattice) {
  return std::abs(lattice.turn_x_deg) > kMostTurn_deg ||
         std::abs(lattice.turn_y_deg - lattice.turn_x_deg) > kMostSkew_deg;
}

Result<Straightened> straighten(const Surface& surface, const Lattice& lattice,
                                const StraightenOptions& options) {
  if (auto usable = check_surface(surface, kLeastSide, kNotStraightened); !usable)
    return std::move(usable).error();
  if (lattice.kind != LatticeKind::kRepeat) {
    return not_straightened(ErrorKind::kBadData, std::string(words_of(lattice.kind)),
                            "turn the cloth by hand, or take a larger or sharper part of it");
  }
  Straightened out;
  // A plain weave's yarns are half its repeat apart, so they carry twice as many waves as their repeat says.
  const double sigma_px =
      options.lock_in_repeats * std::sqrt(std::min(lattice.axes.area(), 4 * lattice.weave.area()));
  if (sigma_px > 0) out.displacement = lock_in(surface, lattice.weave, sigma_px, options.threads);
  Result<StraightGrid> grid = straight_grid_of(surface, lattice, out.displacement, options);
  if (!grid) return std::move(grid).error();
  out.lookup = lookup_of(*grid, out.displacement, options.threads);
  out.repeats_x = grid->repeats_x;
  out.repeats_y = grid->repeats_y;
  out.period_px = grid->period_px;
  out.mm_per_pixel_x = surface.mm_per_pixel * length(grid->by_column);
  out.mm_per_pixel_y = surface.mm_per_pixel * length(grid->by_row);
  out.turn_deg = lattice.turn_x_deg;
  out.skew_deg = lattice.turn_y_deg - lattice.turn_x_deg;
  state_pull(surface.mm_per_pixel, out);
  out.surface = resampled(surface, out.lookup, out.mm_per_pixel_x, out.mm_per_pixel_y, options.threads);
  return out;
}

}  // namespace weft::material
