// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/slices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/vec.h"
#include "solver/transport/heights.h"
#include "solver/transport/planes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/transport/slices.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "solver/transport/heights-inl.h"

#ifndef WEFT_SOLVER_TRANSPORT_SLICES
#define WEFT_SOLVER_TRANSPORT_SLICES
namespace weft::solver {
namespace slices {

// A point of a half-plane, relative to the pixel.
struct Step {
  PointBetween at;           // in heights
  float inverse_px;          // one over its distance
  std::ptrdiff_t radiosity;  // from the pixel to that whose light is taken
};

struct Direction {
  float x, y;  // y upwards
  std::vector<Step> steps;
};

// A row of a tile. Rows are padded.
struct Row {
  const float* height;  // at the first pixel, as all that follows
  std::ptrdiff_t height_stride;
  const float *normal_x, *normal_y, *normal_z;
  std::vector<const float*> radiosity;
  std::vector<float*> arriving;
  std::vector<float> sums;  // of one vector
  int width;
  float top_px;
};

}  // namespace slices
}  // namespace weft::solver
#endif

HWY_BEFORE_NAMESPACE();
namespace weft::solver {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// F(t) of a direction, for each pixel.
struct Share {
  LaneTag d;
  Lanes along, up;  // half of n . d and of n.z, over the number of directions, times two

  HWY_INLINE Lanes operator()(Lanes t) const {
    const Lanes one = hn::Set(d, 1.0F);
    const Lanes over = hn::Div(t, hn::MulAdd(t, t, one));
    return hn::MulAdd(along, hn::Add(hn::Atan(d, t), over), hn::Mul(up, hn::Mul(t, over)));
  }
};

// Adds what a vector of pixels from column x on is sent from one direction.
void gather_direction(const slices::Direction& direction, float share, int x, slices::Row& row) {
  const LaneTag d;
  const float* here = row.height + x;
  const Lanes z = hn::Add(hn::LoadU(d, here), hn::Set(d, kLift));
  const Lanes n_z = hn::LoadU(d, row.normal_z + x);
  const Lanes n_d = hn::MulAdd(hn::Set(d, direction.x), hn::LoadU(d, row.normal_x + x),
                               hn::Mul(hn::Set(d, direction.y), hn::LoadU(d, row.normal_y + x)));
  const Share share_of{d, hn::Mul(hn::Set(d, share), n_d), hn::Mul(hn::Set(d, share), n_z)};
  const Lanes rise = hn::Sub(hn::Set(d, row.top_px), z);
  Lanes horizon = hn::Neg(hn::Div(n_d, n_z));
  Lanes taken = share_of(horizon);
  for (const slices::Step& step : direction.steps) {
    const Lanes inverse = hn::Set(d, step.inverse_px);
    if (hn::AllFalse(d, hn::Gt(hn::Mul(rise, inverse), horizon))) break;
    const Lanes t = hn::Mul(hn::Sub(height_at(here, row.height_stride, step.at), z), inverse);
    const auto rises = hn::Gt(t, horizon);
    if (hn::AllFalse(d, rises)) continue;
    const Lanes reached = share_of(t);
    const Lanes weight = hn::IfThenElseZero(rises, hn::Sub(reached, taken));
    taken = hn::IfThenElse(rises, reached, taken);
    horizon = hn::Max(horizon, t);
    float* sum = row.sums.data();
    for (const float* plane : row.radiosity) {
      hn::StoreU(hn::MulAdd(weight, hn::LoadU(d, plane + x + step.radiosity), hn::LoadU(d, sum)), d, sum);
      sum += hn::Lanes(d);
    }
  }
}

void gather_slices(const std::vector<slices::Direction>& directions, slices::Row& row) {
  const LaneTag d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const float share = 1 / static_cast<float>(directions.size());
  for (int x = 0; x < row.width; x += lanes) {
    std::ranges::fill(row.sums, 0.0F);
    for (const slices::Direction& direction : directions) gather_direction(direction, share, x, row);
    const auto count = static_cast<std::ptrdiff_t>(std::min(lanes, row.width - x));
    for (std::size_t k = 0; k < row.arriving.size(); ++k)
      std::copy_n(row.sums.begin() + static_cast<std::ptrdiff_t>(k) * lanes, count, row.arriving[k] + x);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace weft::solver {
namespace {

HWY_EXPORT(gather_slices);

// Counts of directions, and of steps.
constexpr int kFewest = 4, kMost = 64;
constexpr double kLeastStep_px = 0.5;

// To the nearest pixel a whole number of steps away.
std::ptrdiff_t snapped(double at, int step) {
  return static_cast<std::ptrdiff_t>(step * std::lround(at / step));
}

std::vector<slices::Direction> directions_of(const SliceSettings& settings, std::ptrdiff_t height_stride,
                                             std::ptrdiff_t radiosity_stride) {
  std::vector<slices::Direction> directions;
  const int snap = settings.mosaic ? 2 : 1;
  for (int i = 0; i < settings.directions; ++i) {
    const double turn = 2 * kPi * (i + 0.5) / settings.directions;
    const double c = std::cos(turn), s = std::sin(turn);
    slices::Direction& direction = directions.emplace_back();
    direction.x = static_cast<float>(c);
    direction.y = static_cast<float>(s);
    double before = 0;
    for (double at = kLeastStep_px; at <= settings.reach_px;
         before = at, at += std::max(kLeastStep_px, at / settings.steps)) {
      const double middle = (before + at) / 2;
      direction.steps.push_back({point_between(c * at, -s * at, height_stride), static_cast<float>(1 / at),
                                 snapped(-s * middle, snap) * radiosity_stride + snapped(c * middle, snap)});
    }
  }
  return directions;
}

// One row of normals, those that are none looking up.
void read_normals(const Normals& normals, int row, int width, Image<float>& into) {
  for (int x = 0; x < into.width(); ++x) {
    const Vec3 n = x < width ? normal_or_up(normals, x, row) : Vec3{0, 0, 1};
    into(x, 0, 0) = static_cast<float>(n.x);
    into(x, 0, 1) = static_cast<float>(n.y);
    into(x, 0, 2) = static_cast<float>(n.z);
  }
}

Result<void> check(const Relief& relief, Rect tile, const Normals& normals, const RadiosityPlanes& radiosity,
                   const SliceSettings& settings, std::span<const View<float>> arriving) {
  const auto is_count = [](int count) { return count >= kFewest && count <= kMost; };
  if (!is_count(settings.directions) || !is_count(settings.steps) || settings.reach_px < 1) {
    return bad_transport(
        "slices",
        fmt::format("{} directions to {} pixels by steps of one over {}", settings.directions,
                    settings.reach_px, settings.steps),
        fmt::format("ask for from {} to {} directions and steps and at least 1 pixel", kFewest, kMost));
  }
  if (!holds_pixels(relief.pixels(), tile)) {
    return bad_transport("tile", "it is not inside the picture", "ask for a tile inside the picture");
  }
  if (auto checked = check_normals(normals, tile); !checked) return checked;
  const Rect needed = area_of_slices(tile, settings.reach_px);
  const auto holds = [](const auto& views, Rect part) {
    return std::ranges::all_of(views, [&](const auto& view) { return holds_tile(view, part); });
  };
  if (radiosity.planes.empty() || !holds_pixels(radiosity.area, needed) ||
      !holds(radiosity.planes, radiosity.area)) {
    return bad_transport(
        "radiosity",
        fmt::format("{} planes for columns {} to {} and rows {} to {}", radiosity.planes.size(),
                    radiosity.area.x0, radiosity.area.x1, radiosity.area.y0, radiosity.area.y1),
        fmt::format("give what columns {} to {} and rows {} to {} send back", needed.x0, needed.x1, needed.y0,
                    needed.y1));
  }
  if (arriving.size() == radiosity.planes.size() && holds(arriving, tile)) return {};
  return bad_transport("arriving light",
                       fmt::format("{} planes for {} numbers a pixel, or planes smaller than the tile",
                                   arriving.size(), radiosity.planes.size()),
                       fmt::format("give {} planes of the tile's size", radiosity.planes.size()));
}

bool is_finite(std::span<const View<float>> planes, Rect tile) {
  return std::ranges::all_of(planes, [&](const View<float>& plane) {
    for (int y = 0; y < tile.height(); ++y) {
      if (!std::all_of(plane.row(y), plane.row(y) + tile.width(), [](float v) { return std::isfinite(v); }))
        return false;
    }
    return true;
  });
}

}  // namespace

Rect area_of_slices(Rect tile, int reach_px) {
  const int halo = reach_px + 1;
  return {tile.x0 - halo, tile.y0 - halo, tile.x1 + halo, tile.y1 + halo};
}

Result<void> gather_by_slices(const Relief& relief, Rect tile, const Normals& normals,
                              const RadiosityPlanes& radiosity, const SliceSettings& settings,
                              std::span<const View<float>> arriving) {
  if (auto checked = check(relief, tile, normals, radiosity, settings, arriving); !checked) return checked;
  const Rect area = area_of_slices(tile, settings.reach_px);
  const Image<float> height = heights_around(relief, area);
  const std::ptrdiff_t stride = height.plane().stride();
  const auto directions = directions_of(settings, stride, radiosity.planes.front().stride());
  Image<float> normal({tile.width() + kMostLanes, 1}, 3);
  slices::Row row;
  row.height_stride = stride;
  row.width = tile.width();
  row.top_px = relief.top_px();
  row.sums.resize(arriving.size() * kMostLanes);
  for (int y = 0; y < tile.height(); ++y) {
    read_normals(normals, y, tile.width(), normal);
    row.height = height.plane().row(y + tile.y0 - area.y0) + (tile.x0 - area.x0);
    row.normal_x = normal.plane(0).row(0);
    row.normal_y = normal.plane(1).row(0);
    row.normal_z = normal.plane(2).row(0);
    row.radiosity.clear();
    row.arriving.clear();
    for (std::size_t k = 0; k < arriving.size(); ++k) {
      row.radiosity.push_back(radiosity.planes[k].row(y + tile.y0 - radiosity.area.y0) +
                              (tile.x0 - radiosity.area.x0));
      row.arriving.push_back(arriving[k].row(y));
    }
    HWY_DYNAMIC_DISPATCH(gather_slices)(directions, row);
  }
  if (is_finite(arriving, tile)) return {};
  return bad_transport("radiosity", "what a pixel sends back is not finite",
                       "replace readings that cannot be used");
}

}  // namespace weft::solver
#endif
