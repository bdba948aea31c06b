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
#include "material/finish/resample.h"
#include "material/usable.h"

namespace weft::material {
namespace {

constexpr int kMostSide = 32768, kLookupStep = 8, kLeastSide = 64;
constexpr double kJoint_px = 48;  ///< what the ends of a tile need at least to be joined
const char* const kNotStraightened = "the cloth cannot be straightened";

Error not_straightened(ErrorKind kind, std::string why, std::string remedy) {
  return {kind, kNotStraightened, "straighten", std::move(why), std::move(remedy)};
}

// Columns and rows along the yarns, around the centre of the photographed cloth.
struct Plan {
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

Result<Plan> plan_of(const Surface& surface, const Lattice& lattice, const Displacement& displacement,
                     const StraightenOptions& options) {
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
  Plan plan = {{size[0], size[1]}, repeats[0], repeats[1], {period[0], period[1]}, {}, {}};
  plan.by_column = (static_cast<double>(plan.repeats_x) / plan.period_px.width) * lattice.axes.a;
  plan.by_row = (-static_cast<double>(plan.repeats_y) / plan.period_px.height) * lattice.axes.b;
  return plan;
}

// Places of x + d(x) = X: pulls are small against their own length, so few rounds do.
Lookup lookup_of(const Plan& plan, const Displacement& displacement, int threads) {
  constexpr int kIterations = 6;
  Lookup lookup(plan.size, kLookupStep);
  parallel_for(static_cast<std::size_t>(lookup.nodes().height), threads, [&](std::size_t row, int) {
    const int j = static_cast<int>(row);
    for (int i = 0; i < lookup.nodes().width; ++i) {
      const Vec2 wanted = plan.lattice_place((i - 1) * kLookupStep, (j - 1) * kLookupStep);
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
  Result<Plan> plan = plan_of(surface, lattice, out.displacement, options);
  if (!plan) return std::move(plan).error();
  out.lookup = lookup_of(*plan, out.displacement, options.threads);
  out.repeats_x = plan->repeats_x;
  out.repeats_y = plan->repeats_y;
  out.period_px = plan->period_px;
  out.mm_per_pixel_x = surface.mm_per_pixel * length(plan->by_column);
  out.mm_per_pixel_y = surface.mm_per_pixel * length(plan->by_row);
  out.turn_deg = lattice.turn_x_deg;
  out.skew_deg = lattice.turn_y_deg - lattice.turn_x_deg;
  state_pull(surface.mm_per_pixel, out);
  out.surface = resampled(surface, out.lookup, out.mm_per_pixel_x, out.mm_per_pixel_y, options.threads);
  return out;
}

}  // namespace weft::material
