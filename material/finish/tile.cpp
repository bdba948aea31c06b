// SPDX-License-Identifier: Apache-2.0
#include "material/finish/tile.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "core/base/statistics.h"
#include "core/base/vec.h"
#include "core/solve/solve_record.h"
#include "material/finish/part.h"
#include "material/finish/periodic_height.h"
#include "material/finish/seam.h"
#include "material/usable.h"

namespace weft::material {
namespace {

constexpr int kLeastOverlap_px = 48, kMostPlaces = 64, kBlock_px = 16;
const char* const kNoTile = "no tile can be cut";

Error no_tile(ErrorKind kind, std::string why, std::string remedy) {
  return Error{kind, kNoTile, "tile", std::move(why), std::move(remedy)};
}

// What is cut along one axis.
struct Side {
  int period = 0, overlap = 0;
  std::vector<int> starts;
};

Result<Side> side_of(int length, int period, double repeat, const TilingOptions& options, const char* axis) {
  if (repeat > length / 2.0) {
    return no_tile(
        ErrorKind::kBadData,
        fmt::format("a repeat along {} is {:.1f} pixels, the cloth {} pixels", axis, repeat, length),
        "photograph at least two repeats");
  }
  Side side;
  side.overlap = options.overlap_px > 0 ? options.overlap_px
                 : repeat > 0 ? static_cast<int>(std::ceil(std::ceil(kLeastOverlap_px / repeat) * repeat))
                              : std::max(kLeastOverlap_px, length / 8);
  side.period = period > 0 ? period : length - side.overlap;
  if (repeat > 0 && period <= 0) {
    // The most repeats whose length is nearest to a whole number of pixels.
    double least = 1;
    for (int n = static_cast<int>(side.period / repeat); n >= 1 && n * repeat > 0.8 * side.period; --n) {
      const double off = std::abs(n * repeat - std::round(n * repeat));
      if (off < least - 0.01) least = off, side.period = static_cast<int>(std::lround(n * repeat));
    }
  }
  // Whatever is left beyond the period can hold the cut, but less than the feathers need cannot.
  side.overlap = std::min({side.overlap, length - side.period, side.period});
  if (side.period < 1 || side.overlap < 4 * options.feather_px + 1) {
    return no_tile(
        ErrorKind::kBadData,
        fmt::format("{} pixels and what joins them do not fit into {} along {}", side.period, length, axis),
        "ask for fewer repeats");
  }
  if (repeat > 0) {
    const double repeats = side.period / repeat, off = std::abs(repeats - std::round(repeats)) * repeat;
    if (repeats < 0.5 || off > 0.5) {
      return no_tile(ErrorKind::kUsage,
                     fmt::format("{} pixels along {} are {:.3f} repeats", side.period, axis, repeats),
                     "straighten for as many repeats as the tile shall have");
    }
  }
  const double step = repeat > 0 ? repeat : std::max(1.0, side.overlap / 2.0);
  for (double start = 0; std::lround(start) + side.period + side.overlap <= length; start += step)
    side.starts.push_back(static_cast<int>(std::lround(start)));
  return side;
}

// Pixels without a solution by blocks, so that a start is judged without looking at all of them.
class Unsolved {
 public:
  explicit Unsolved(const Surface& surface)
      : count_({(surface.size().width + kBlock_px - 1) / kBlock_px,
                (surface.size().height + kBlock_px - 1) / kBlock_px}) {
    for (int y = 0; y < surface.size().height; ++y) {
      for (int x = 0; x < surface.size().width; ++x)
        count_(x / kBlock_px, y / kBlock_px) += (surface.status(x, y) & kNoSolution) != 0 ? 1 : 0;
    }
  }
  double in(Rect part) const {
    std::int64_t sum = 0;
    for (int y = part.y0 / kBlock_px; y <= (part.y1 - 1) / kBlock_px; ++y) {
      for (int x = part.x0 / kBlock_px; x <= (part.x1 - 1) / kBlock_px; ++x) sum += count_(x, y);
    }
    return static_cast<double>(sum);
  }

 private:
  Image<std::int32_t> count_;
};

struct Start {
  int x = 0, y = 0, places = 0;
};

// Every so-manieth of the starts, so that at most eight a side are compared.
std::vector<int> thinned(const std::vector<int>& starts) {
  constexpr std::size_t kMostASide = 8;
  static_assert(kMostASide * kMostASide == kMostPlaces);
  if (starts.size() <= kMostASide) return starts;
  std::vector<int> out;
  for (std::size_t i = 0; i < kMostASide; ++i)
    out.push_back(starts[i * (starts.size() - 1) / (kMostASide - 1)]);
  return out;
}

Start best_start(const Surface& surface, const Side& x, const Side& y, int margin, const Scales& scales) {
  const Unsolved unsolved(surface);
  Start best;
  double least = std::numeric_limits<double>::infinity();
  int places = 0;
  for (const int y0 : thinned(y.starts)) {
    for (const int x0 : thinned(x.starts)) {
      const Rect part = {x0, y0, x0 + x.period + x.overlap, y0 + y.period + y.overlap};
      // A pixel without a solution is as bad as a whole row of the cut that differs.
      double cost = unsolved.in(part);
      const Image<float> across = difference_in(surface, {Axis::kX, x.period, x.overlap}, x0, y0,
                                                y.period + y.overlap, y.period, scales);
      const Image<float> down =
          difference_in(surface, {Axis::kY, y.period, y.overlap}, x0, y0, x.period, 0, scales);
      cost += least_open_cost(across.plane(), margin) * y.period +
              least_open_cost(down.plane(), margin) * x.period;
      ++places;
      if (cost < least) best = {x0, y0, 0}, least = cost;
    }
  }
  best.places = places;
  return best;
}

// 1 where both sides are mixed, within half a feather of a cut, 0 from a feather on.
double closeness(int place, int column, int feather) {
  return std::clamp(2 - 2 * std::abs(place + 0.5 - column) / feather, 0.0, 1.0);
}

double angle_between_deg(Vec2 a, Vec2 b) {
  return angle_deg({-a.x, -a.y, 1}, {-b.x, -b.y, 1});
}

// Near the cuts the slopes become the height's, and the angles that remain are stated.
void make_integrable(const Cut& across, const Cut& down, int feather, Tile& tile, int threads) {
  PeriodicHeight periodic = periodic_height(tile.surface.slope, threads);
  tile.mean_right = periodic.mean_right;
  tile.mean_up = periodic.mean_up;
  Image<float>& slope = tile.surface.slope;
  std::vector<float> at_cuts, everywhere;
  float lowest = 0, highest = 0;
  for (int y = 0; y < slope.height(); ++y) {
    for (int x = 0; x < slope.width(); ++x) {
      const double weight = std::max(closeness(x, across.column[static_cast<std::size_t>(y)], feather),
                                     closeness(y, down.column[static_cast<std::size_t>(x)], feather));
      const Vec2 own = {static_cast<double>(slope(x, y, 0)) - tile.mean_right,
                        static_cast<double>(slope(x, y, 1)) - tile.mean_up};
      const Vec2 of_height = {static_cast<double>(periodic.slope(x, y, 0)),
                              static_cast<double>(periodic.slope(x, y, 1))};
      const Vec2 mixed = weight * of_height + (1 - weight) * own;
      slope(x, y, 0) = static_cast<float>(mixed.x);
      slope(x, y, 1) = static_cast<float>(mixed.y);
      const auto angle = static_cast<float>(angle_between_deg(mixed, of_height));
      everywhere.push_back(angle);
      if (weight == 1) at_cuts.push_back(angle);
      lowest = std::min(lowest, periodic.height(x, y));
      highest = std::max(highest, periodic.height(x, y));
    }
  }
  const auto mm = static_cast<float>(tile.surface.mm_per_pixel);
  for (int y = 0; y < slope.height(); ++y) {
    for (int x = 0; x < slope.width(); ++x) periodic.height(x, y) *= mm;
  }
  tile.height_mm = std::move(periodic.height);
  tile.relief_mm = static_cast<double>(mm * (highest - lowest));
  tile.normal_p99_deg = static_cast<double>(quantile(std::move(everywhere), 0.99));
  tile.normal_p99_at_cuts_deg = static_cast<double>(quantile(std::move(at_cuts), 0.99));
}

Result<void> check_options(const Surface& surface, const TilingOptions& options) {
  if (auto usable = check_surface(surface, 2 * kLeastOverlap_px, kNoTile); !usable) return usable;
  if (surface.is_tile)
    return no_tile(ErrorKind::kUsage, "it is a tile already", "take the cloth it was cut from");
  if (options.feather_px < 1 || options.feather_px > 16)
    return no_tile(ErrorKind::kUsage, "the feather is not 1 to 16 pixels", "ask for 3");
  if (!(options.repeat_x_px >= 0 && options.repeat_y_px >= 0))
    return no_tile(ErrorKind::kUsage, "a repeat is below 0", "find the lattice, or give 0 for none");
  return {};
}

}  // namespace

TilingOptions tile_of(const Straightened& straightened) {
  TilingOptions options;
  options.period_px = straightened.period_px;
  options.repeat_x_px = static_cast<double>(straightened.period_px.width) / straightened.repeats_x;
  options.repeat_y_px = static_cast<double>(straightened.period_px.height) / straightened.repeats_y;
  return options;
}

Result<Tile> tile(const Surface& surface, const TilingOptions& options) {
  if (auto fine = check_options(surface, options); !fine) return std::move(fine).error();
  const Size size = surface.size();
  const auto x = side_of(size.width, options.period_px.width, options.repeat_x_px, options, "x");
  if (!x) return x.error();
  const auto y = side_of(size.height, options.period_px.height, options.repeat_y_px, options, "y");
  if (!y) return y.error();

  const Scales scales = scales_of(surface);
  const int feather = options.feather_px, margin = 2 * feather;
  const Start start = best_start(surface, *x, *y, margin, scales);
  const Surface whole = part_of(
      surface, {start.x, start.y, start.x + x->period + x->overlap, start.y + y->period + y->overlap});
  const Overlap in_x = {Axis::kX, x->period, x->overlap}, in_y = {Axis::kY, y->period, y->overlap};
  const Cut across =
      least_cut(difference_in(whole, in_x, 0, 0, y->period + y->overlap, y->period, scales).plane(), margin);
  const Surface wrapped = joined(whole, in_x, across, feather);
  const Cut down = least_cut(difference_in(wrapped, in_y, 0, 0, x->period, 0, scales).plane(), margin);

  Tile out;
  out.surface = joined(wrapped, in_y, down, feather);
  out.surface.is_tile = true;
  out.x0 = start.x;
  out.y0 = start.y;
  out.places = start.places;
  out.has_repeat = options.repeat_x_px > 0 && options.repeat_y_px > 0;
  make_integrable(across, down, feather, out, options.threads);
  out.x = seam_of(out, whole, in_x, across, y->overlap, options);
  out.y = seam_of(out, wrapped, in_y, down, 0, options);
  return out;
}

}  // namespace weft::material
