// SPDX-License-Identifier: Apache-2.0
#include "material/finish/repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/solve/solve_record.h"
#include "material/cubic.h"
#include "material/finish/join.h"
#include "material/finish/part.h"
#include "material/usable.h"

namespace weft::material {
namespace {

constexpr int kMostReach = 12, kRefined = 8, kTaps = 2;

Error not_repaired(ErrorKind kind, std::string where, std::string why, std::string remedy) {
  return {kind, "the cloth is not repaired", std::move(where), std::move(why), std::move(remedy)};
}

// A spot in pixels, x right and y down.
struct Shape {
  double x = 0, y = 0, radius = 0, half_width = 0, half_height = 0;

  // To its rim, below 0 within.
  double distance(int column, int row) const {
    const double dx = std::abs(column - x), dy = std::abs(row - y);
    if (radius > 0) return std::hypot(dx, dy) - radius;
    const double across = dx - half_width, down = dy - half_height;
    return std::hypot(std::max(across, 0.0), std::max(down, 0.0)) + std::min(std::max(across, down), 0.0);
  }
  Rect box(int margin) const {
    const double w = (radius > 0 ? radius : half_width) + margin,
                 h = (radius > 0 ? radius : half_height) + margin;
    return {static_cast<int>(std::floor(x - w)), static_cast<int>(std::floor(y - h)),
            static_cast<int>(std::ceil(x + w)) + 1, static_cast<int>(std::ceil(y + h)) + 1};
  }
};

Shape shape_of(const Spot& spot, double mm) {
  const bool is_rect = spot.width_mm > 0 && spot.height_mm > 0;
  return {spot.x_mm / mm - 0.5, spot.y_mm / mm - 0.5, is_rect ? 0 : spot.radius_mm / mm,
          is_rect ? spot.width_mm / mm / 2 : 0, is_rect ? spot.height_mm / mm / 2 : 0};
}

// A surface whose borders are met by going on (tile) or not at all.
class Cloth {
 public:
  explicit Cloth(const Surface& surface) : surface_(surface), scales_(scales_of(surface)) {}
  const Surface& surface() const { return surface_; }
  const Scales& scales() const { return scales_; }
  int column(int x) const { return wrapped(x, surface_.size().width); }
  int row(int y) const { return wrapped(y, surface_.size().height); }
  bool holds(int x, int y) const {
    return surface_.is_tile || (x >= 0 && y >= 0 && x < surface_.size().width && y < surface_.size().height);
  }
  bool is_solved(int x, int y) const { return (surface_.status(column(x), row(y)) & kNoSolution) == 0; }
  double at(const Image<float>& map, int plane, double x, double y) const {
    const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
    double sum = 0;
    for (int j = top - 1; j <= top + 2; ++j) {
      const double down = cubic_weight(j - y);
      if (down == 0) continue;
      for (int i = left - 1; i <= left + 2; ++i)
        sum += down * cubic_weight(i - x) * static_cast<double>(map(column(i), row(j), plane));
    }
    return sum;
  }

 private:
  static int wrapped(int i, int n) { return (i % n + n) % n; }

  const Surface& surface_;
  Scales scales_;
};

bool overlap(Rect a, Rect b) {
  return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}

// What is asked of all spots.
struct Task {
  const Cloth& cloth;
  const RepairOptions& options;
  std::vector<Shape> shapes;
};

// Whether what a spot needs from `source` away is in the cloth, solved and no spot.
bool can_serve(const Task& task, const Shape& shape, Vec2 source) {
  const Rect box = shape.box(task.options.feather_px + kTaps);
  const int dx = static_cast<int>(std::lround(source.x)), dy = -static_cast<int>(std::lround(source.y));
  const Rect from = {box.x0 + dx, box.y0 + dy, box.x1 + dx, box.y1 + dy};
  if (!task.cloth.holds(from.x0, from.y0) || !task.cloth.holds(from.x1 - 1, from.y1 - 1)) return false;
  const Size size = task.cloth.surface().size();
  for (const Shape& other : task.shapes) {
    const Rect taken = other.box(task.options.feather_px);
    for (const int i : {-1, 0, 1}) {
      for (const int j : {-1, 0, 1}) {
        if ((i != 0 || j != 0) && !task.cloth.surface().is_tile) continue;
        const int x = i * size.width, y = j * size.height;
        if (overlap(from, {taken.x0 + x, taken.y0 + y, taken.x1 + x, taken.y1 + y})) return false;
      }
    }
  }
  for (int y = from.y0; y < from.y1; ++y) {
    for (int x = from.x0; x < from.x1; ++x) {
      if (!task.cloth.is_solved(x, y)) return false;
    }
  }
  return true;
}

// Visits the solved pixels of the ring around a spot.
template <typename Visit>
void each_in_ring(const Task& task, const Shape& shape, int every, Visit&& visit) {
  const Rect box = shape.box(task.options.ring_px);
  for (int y = box.y0; y < box.y1; y += every) {
    for (int x = box.x0; x < box.x1; x += every) {
      const double distance = shape.distance(x, y);
      if (distance > 0 && distance <= task.options.ring_px && task.cloth.holds(x, y) &&
          task.cloth.is_solved(x, y))
        visit(x, y);
    }
  }
}

// Mean squared difference between the ring and what lies `source` away, in variances: 2 for what has nothing
// in common.
double mismatch_of(const Task& task, const Shape& shape, Vec2 source, int every) {
  const Cloth& cloth = task.cloth;
  const Surface& surface = cloth.surface();
  double sum = 0;
  int count = 0;
  const int green = surface.albedo.planes() / 2;
  each_in_ring(task, shape, every, [&](int x, int y) {
    const double from_x = x + source.x, from_y = y - source.y;
    if (!cloth.holds(static_cast<int>(std::floor(from_x)) - 1, static_cast<int>(std::floor(from_y)) - 1) ||
        !cloth.holds(static_cast<int>(from_x) + 2, static_cast<int>(from_y) + 2))
      return;
    const auto add = [&](const Image<float>& map, int plane, double scale) {
      const double d = (cloth.at(map, plane, from_x, from_y) -
                        static_cast<double>(map(cloth.column(x), cloth.row(y), plane))) /
                       scale;
      sum += d * d / 3;
    };
    for (int p = 0; p < 2; ++p) add(surface.slope, p, cloth.scales().slope[static_cast<std::size_t>(p)]);
    add(surface.albedo, green, cloth.scales().albedo[static_cast<std::size_t>(green)]);
    ++count;
  });
  return count > 0 ? sum / count : 4;
}

struct Candidate {
  Vec2 source;
  int i = 0, j = 0;
  double mismatch = 0;
};

std::optional<Candidate> best_source(const Task& task, const Shape& shape) {
  std::vector<Candidate> candidates;
  for (int j = -kMostReach; j <= kMostReach; ++j) {
    for (int i = -kMostReach; i <= kMostReach; ++i) {
      const Vec2 source = task.options.cell.at(i, j);
      if ((i != 0 || j != 0) && can_serve(task, shape, source)) candidates.push_back({source, i, j, 0});
    }
  }
  if (candidates.empty()) return std::nullopt;
  const auto measure = [&](std::vector<Candidate>& all, int every) {
    parallel_for(all.size(), task.options.threads, [&](std::size_t k, int) {
      all[k].mismatch = mismatch_of(task, shape, all[k].source, every);
    });
    std::ranges::stable_sort(all, {}, &Candidate::mismatch);
  };
  measure(candidates, 3);
  candidates.resize(std::min<std::size_t>(candidates.size(), kRefined));
  std::vector<Candidate> moved;
  for (const Candidate& each : candidates) {
    for (int y = -4; y <= 4; ++y) {
      for (int x = -4; x <= 4; ++x) {
        const Vec2 source = each.source + Vec2{x / 2.0, y / 2.0};
        if (can_serve(task, shape, source)) moved.push_back({source, each.i, each.j, 0});
      }
    }
  }
  measure(moved, 2);
  return moved.front();
}

// The median of what the ring's albedo is over that of the source, at most twofold.
double tone_of(const Task& task, const Shape& shape, Vec2 source, int plane) {
  constexpr double kDarkest = 1e-5;
  const Image<float>& albedo = task.cloth.surface().albedo;
  std::vector<double> logs;
  each_in_ring(task, shape, 1, [&](int x, int y) {
    const double there = task.cloth.at(albedo, plane, x + source.x, y - source.y),
                 here = static_cast<double>(albedo(task.cloth.column(x), task.cloth.row(y), plane));
    logs.push_back(std::log(std::max(here, kDarkest)) - std::log(std::max(there, kDarkest)));
  });
  return logs.empty() ? 1 : std::exp(std::clamp(median(std::move(logs)), -0.7, 0.7));
}

// 1 in a spot, 0 from a feather on.
double cover(double distance, int feather) {
  const double t = std::clamp(1 - distance / std::max(feather, 1), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// From the cloth as it was before any spot was filled.
int fill(const Task& task, const Shape& shape, Vec2 source, Surface& out) {
  const Cloth& cloth = task.cloth;
  const Surface& was = cloth.surface();
  std::array<double, 3> tone = {1, 1, 1};
  for (int p = 0; p < was.albedo.planes(); ++p)
    tone[static_cast<std::size_t>(p)] = tone_of(task, shape, source, p);
  const Rect box = shape.box(task.options.feather_px);
  int filled = 0;
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      const double distance = shape.distance(x, y), weight = cover(distance, task.options.feather_px);
      if (!(weight > 0) || !cloth.holds(x, y)) continue;
      filled += distance <= 0;
      const int to_x = cloth.column(x), to_y = cloth.row(y);
      // A rim without a solution has nothing to be mixed with.
      const double mixed = cloth.is_solved(x, y) ? weight : 1;
      const auto mix = [&](const Image<float>& map, Image<float>& result, int p, double factor,
                           double least) {
        if (map.empty()) return;
        const double from = std::max(factor * cloth.at(map, p, x + source.x, y - source.y), least);
        result(to_x, to_y, p) =
            static_cast<float>(mixed * from + (1 - mixed) * static_cast<double>(map(to_x, to_y, p)));
      };
      for (int p = 0; p < 2; ++p) mix(was.slope, out.slope, p, 1, -1e6);
      for (int p = 0; p < was.albedo.planes(); ++p)
        mix(was.albedo, out.albedo, p, tone[static_cast<std::size_t>(p)], 0);
      mix(was.sigma_deg, out.sigma_deg, 0, 1, 0);
      mix(was.opacity, out.opacity, 0, 1, 0);
      if (mixed < 0.5) continue;
      const int from_x = cloth.column(static_cast<int>(std::lround(x + source.x))),
                from_y = cloth.row(static_cast<int>(std::lround(y - source.y)));
      out.status(to_x, to_y) = was.status(from_x, from_y);
      for (int p = 0; p < was.lobe.planes(); ++p) out.lobe(to_x, to_y, p) = was.lobe(from_x, from_y, p);
    }
  }
  return filled;
}

Result<void> check_repair(const Surface& surface, const RepairOptions& options) {
  if (auto usable = check_surface(surface, 16, "the cloth is not repaired"); !usable) return usable;
  if (options.feather_px < 0 || options.feather_px > 16 || options.ring_px < 1 || options.ring_px > 64) {
    return not_repaired(ErrorKind::kUsage, "repair", "feather or ring is out of range",
                        "give a feather of 0 to 16 and a ring of 1 to 64 pixels");
  }
  for (std::size_t i = 0; i < options.spots.size(); ++i) {
    const Spot& spot = options.spots[i];
    const double mm = surface.mm_per_pixel;
    const bool has_pixels = spot.radius_mm >= mm / 2 || (spot.width_mm >= mm && spot.height_mm >= mm);
    const bool is_in = spot.x_mm >= 0 && spot.y_mm >= 0 && spot.x_mm <= surface.size().width * mm &&
                       spot.y_mm <= surface.size().height * mm;
    const bool is_small = std::max({2 * spot.radius_mm, spot.width_mm, spot.height_mm}) <
                          mm * std::min(surface.size().width, surface.size().height);
    if (!(has_pixels && is_in && is_small)) {
      return not_repaired(ErrorKind::kUsage, fmt::format("spot {}", i + 1),
                          "it is not in the cloth or has no pixel",
                          "give a place in the cloth and a radius, or a width and a height");
    }
  }
  return {};
}

// Where a spot is filled from: what it says, or the best that is found.
Result<Candidate> source_of(const Task& task, const Shape& shape, const Spot& spot,
                            const std::string& where) {
  if (spot.source_px) {
    if (!can_serve(task, shape, *spot.source_px)) {
      return not_repaired(ErrorKind::kUsage, where, "its source is not free, solved cloth",
                          "leave the source out");
    }
    return Candidate{*spot.source_px, 0, 0, mismatch_of(task, shape, *spot.source_px, 2)};
  }
  if (!(std::abs(task.options.cell.area()) > 1))
    return not_repaired(ErrorKind::kBadData, where, "the cloth has no repeat", "give a source");
  const auto best = best_source(task, shape);
  if (!best) {
    return not_repaired(ErrorKind::kBadData, where,
                        fmt::format("none of {} repeats around it is free, solved cloth", kMostReach),
                        "fill less at a time, or give a source");
  }
  return *best;
}

}  // namespace

Result<Repaired> repair(Surface surface, const RepairOptions& options) {
  if (auto fine = check_repair(surface, options); !fine) return std::move(fine).error();
  Surface was = part_of(surface, {0, 0, surface.size().width, surface.size().height});
  was.is_tile = surface.is_tile;
  const Cloth cloth(was);
  Task task = {cloth, options, {}};
  for (const Spot& spot : options.spots) task.shapes.push_back(shape_of(spot, was.mm_per_pixel));
  Repaired out;
  for (std::size_t i = 0; i < options.spots.size(); ++i) {
    const Shape& shape = task.shapes[i];
    const Result<Candidate> source = source_of(task, shape, options.spots[i], fmt::format("spot {}", i + 1));
    if (!source) return source.error();
    Filled filled = {options.spots[i], source->i, source->j, source->mismatch, 0};
    filled.spot.source_px = source->source;
    filled.pixels = fill(task, shape, source->source, surface);
    out.filled.push_back(filled);
  }
  out.surface = std::move(surface);
  return out;
}

}  // namespace weft::material
