// SPDX-License-Identifier: Apache-2.0
#include "material/layers/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "material/layers/lay.h"

namespace weft::material {
namespace {

constexpr double kNearWhole = 0.005;

// Pixels of a layer that a pixel of the grid is made of, and their weights.
struct Taps {
  std::vector<int> columns;
  std::vector<double> weights;
};

int held(int at, int count, bool wraps) {
  if (!wraps) return std::clamp(at, 0, count - 1);
  const int rest = at % count;
  return rest < 0 ? rest + count : rest;
}

// `scale`: the layer's pixels a pixel of the grid.
Taps taps_at(int at, double begin_px, double scale, int count, bool wraps) {
  constexpr double kOnPixel = 1e-7;
  double centre = (at + 0.5 - begin_px) * scale - 0.5;
  if (std::abs(centre - std::round(centre)) < kOnPixel) centre = std::round(centre);
  const double reach = std::max(1.0, scale);
  Taps taps;
  double sum = 0;
  for (int i = static_cast<int>(std::ceil(centre - reach)); i <= static_cast<int>(std::floor(centre + reach));
       ++i) {
    const double weight = 1 - std::abs(i - centre) / reach;
    if (!(weight > 0)) continue;
    taps.columns.push_back(held(i, count, wraps));
    taps.weights.push_back(weight);
    sum += weight;
  }
  for (double& weight : taps.weights) weight /= sum;
  return taps;
}

std::vector<Taps> taps_of(int size, double begin_px, double repeats, int count, bool wraps) {
  const double scale = repeats * count / size;
  std::vector<Taps> all;
  all.reserve(static_cast<std::size_t>(size));
  for (int at = 0; at < size; ++at) all.push_back(taps_at(at, begin_px, scale, count, wraps));
  return all;
}

// Rows along x, then columns: what is between has the grid's width and the layer's height.
void resample(View<const float> from, View<float> to, const LayerFit& fit, int threads) {
  const std::vector<Taps> across = taps_of(to.width(), fit.left_px, fit.across, from.width(), fit.wraps);
  const std::vector<Taps> down = taps_of(to.height(), fit.top_px, fit.down, from.height(), fit.wraps);
  Image<float> wide({to.width(), from.height()});
  parallel_for(static_cast<std::size_t>(from.height()), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < to.width(); ++x) {
      const Taps& taps = across[static_cast<std::size_t>(x)];
      double sum = 0;
      for (std::size_t i = 0; i < taps.weights.size(); ++i)
        sum += taps.weights[i] * double{from(taps.columns[i], y)};
      wide(x, y) = static_cast<float>(sum);
    }
  });
  parallel_for(static_cast<std::size_t>(to.height()), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    const Taps& taps = down[row];
    for (int x = 0; x < to.width(); ++x) {
      double sum = 0;
      for (std::size_t i = 0; i < taps.weights.size(); ++i)
        sum += taps.weights[i] * double{wide(x, taps.columns[i])};
      to(x, y) = static_cast<float>(sum);
    }
  });
}

// A quarter counter-clockwise: what was right is up.
Image<float> turned_once(const Image<float>& map) {
  Image<float> turned({map.height(), map.width()}, map.planes());
  for (int p = 0; p < map.planes(); ++p) {
    for (int y = 0; y < turned.height(); ++y) {
      for (int x = 0; x < turned.width(); ++x) turned(x, y, p) = map(map.width() - 1 - y, x, p);
    }
  }
  return turned;
}

// Planes of slopes and axes by a quarter turn, an axis by twice as much.
void turn_values(ParameterField& field, BlendSpace space) {
  if (space == BlendSpace::kSlope) {
    const auto turn = [](auto& x, auto& y) { x = -std::exchange(y, x); };
    if (!field.is_map()) return turn(field.constant[0], field.constant[1]);
    for (int y = 0; y < field.map.height(); ++y) {
      for (int x = 0; x < field.map.width(); ++x) turn(field.map(x, y, 0), field.map(x, y, 1));
    }
  } else if (space == BlendSpace::kAxis) {
    for (double& each : field.constant) each = -each;
    for (int p = 0; field.is_map() && p < field.planes; ++p) {
      for (int y = 0; y < field.map.height(); ++y) {
        float* row = field.map.plane(p).row(y);
        for (int x = 0; x < field.map.width(); ++x) row[x] = -row[x];
      }
    }
  }
}

Error no_fit(std::string why, std::string remedy) {
  return {ErrorKind::kUsage, "a layer does not fit what it lies on", "", std::move(why), std::move(remedy)};
}

}  // namespace

Result<LayerFit> fit_layer(const FitSizes& sizes, bool below_is_tile) {
  LayerFit fit = {.quarter_turns = ((sizes.quarter_turns % 4) + 4) % 4};
  std::array<double, 2> own_mm = sizes.layer_mm;
  if (fit.quarter_turns % 2 != 0) std::swap(own_mm[0], own_mm[1]);
  std::array<double, 2> repeats = {}, stretch = {};
  for (std::size_t i = 0; i < 2; ++i) {
    if (!(own_mm[i] > 0 && sizes.below_mm[i] > 0))
      return no_fit("a size in millimetres is not known", "say size_mm of both materials");
    const bool is_asked = sizes.repeat_mm[i] > 0;
    const double repeat_mm = is_asked ? sizes.repeat_mm[i] : own_mm[i];
    const double exact = sizes.below_mm[i] / repeat_mm, whole = std::round(exact);
    const bool fits = whole >= 1 && std::abs(exact / whole - 1) <= kNearWhole;
    if (!fits && (below_is_tile || !is_asked)) {
      return no_fit(
          fmt::format(
              "it repeats every {:.6g} x {:.6g} mm, which does not fit {:.6g} x {:.6g} mm a whole number "
              "of times",
              is_asked ? sizes.repeat_mm[0] : own_mm[0], is_asked ? sizes.repeat_mm[1] : own_mm[1],
              sizes.below_mm[0], sizes.below_mm[1]),
          "say tile_mm for what a repeat is to cover, or size_mm of a whole number of repeats");
    }
    repeats[i] = fits ? whole : exact;
    stretch[i] = sizes.below_mm[i] / repeats[i] / own_mm[i];
  }
  fit.across = repeats[0];
  fit.down = repeats[1];
  fit.stretch_x = stretch[0];
  fit.stretch_y = stretch[1];
  fit.left_px = sizes.offset_mm[0] / sizes.below_mm[0] * sizes.below.width;
  fit.top_px = sizes.offset_mm[1] / sizes.below_mm[1] * sizes.below.height;
  return fit;
}

ParameterField fitted(const ParameterField& field, BlendSpace space, const LayerFit& fit, Size size,
                      int threads) {
  ParameterField turned = copy_of(field);
  for (int i = 0; i < fit.quarter_turns; ++i) {
    if (turned.is_map()) turned.map = turned_once(turned.map);
    turn_values(turned, space);
  }
  if (space == BlendSpace::kSlope && (fit.stretch_x != 1 || fit.stretch_y != 1))
    multiply(turned, {1 / fit.stretch_x, 1 / fit.stretch_y, 1}, threads);
  if (!turned.is_map()) return turned;
  Image<float> map(size, turned.planes);
  for (int p = 0; p < turned.planes; ++p) resample(turned.map.plane(p), map.plane(p), fit, threads);
  return ParameterField::of(std::move(map));
}

}  // namespace weft::material
