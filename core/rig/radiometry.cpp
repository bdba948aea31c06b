// SPDX-License-Identifier: Apache-2.0
#include "core/rig/radiometry.h"

#include <cmath>
#include <cstddef>
#include <limits>

#include "core/rig/dark_counts.h"
#include "core/rig/same_camera.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/rig/radiometry.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace weft {

#ifndef WEFT_RADIOMETRY_ROW
#define WEFT_RADIOMETRY_ROW
// What one row of sites alternates between: [0] even columns, [1] odd columns.
struct RadiometryRow {
  const std::uint16_t* counts;
  const std::uint16_t* dark;  // null without a dark shot
  float black[2], saturated_from[2], per_count[2], a[2], b[2];
  float per_second;
};
#endif

namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void read_row(const RadiometryRow& row, float* out, std::size_t width) {
  constexpr std::size_t kAhead = 512;  // counts come from memory, many frames side by side
  const hn::ScalableTag<float> d;
  const hn::Rebind<std::int32_t, decltype(d)> di;
  const hn::Rebind<std::uint16_t, decltype(d)> du16;
  const std::size_t lanes = hn::Lanes(d);
  const auto load = [&](const std::uint16_t* p) {
    return hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(du16, p)));
  };
  const auto per_second = hn::Set(d, row.per_second);
  const auto one = hn::Set(d, 1.0f);
  const auto infinity = hn::Set(d, std::numeric_limits<float>::infinity());
  for (std::size_t x = 0; x < width; x += lanes) {
    const auto alternate = [&](const float(&two)[2]) {
      if (lanes == 1) return hn::Set(d, two[x & 1]);
      return hn::OddEven(hn::Set(d, two[1]), hn::Set(d, two[0]));
    };
    hwy::Prefetch(row.counts + x + kAhead);
    const auto counts = load(row.counts + x);
    const auto dark = row.dark != nullptr ? load(row.dark + x) : alternate(row.black);
    const auto v = hn::Mul(hn::Sub(counts, dark), alternate(row.per_count));
    const auto linear = hn::Mul(v, hn::MulAdd(hn::MulAdd(alternate(row.b), v, alternate(row.a)), v, one));
    const auto saturated = hn::Ge(counts, alternate(row.saturated_from));
    hn::StoreU(hn::IfThenElse(saturated, infinity, hn::Mul(linear, per_second)), d, out + x);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace weft {

HWY_EXPORT(read_row);

std::array<std::array<float, 2>, 2> black_counts(const RawFrame& like, const Response& response) {
  std::array<std::array<float, 2>, 2> black = like.black;
  if (!response.black_counts) return black;
  const auto offset = static_cast<float>(*response.black_counts - mean_black(like));
  for (auto& row : black) {
    for (float& level : row) level += offset;
  }
  return black;
}

std::array<float, 3> measured_full(const RawFrame& frame, const Response& response) {
  if (!response.levels || response.levels->full_rgb.empty()) return {};
  if (response.iso && frame.shot.iso > 0 && !same_setting(*response.iso, frame.shot.iso)) return {};
  if (!response.levels->are_of(frame)) return {};
  std::array<float, 3> full;
  for (std::size_t c = 0; c < 3; ++c) full[c] = static_cast<float>(response.levels->full_rgb[c]);
  return full;
}

Radiometry::Radiometry(const RawFrame& like, const RawFrame* dark, const Response& response,
                       Exposure exposure)
    : dark_(dark != nullptr ? dark->counts.plane() : View<const std::uint16_t>()),
      cfa_(like.cfa),
      black_(dark == nullptr ? black_counts(like, response) : like.black),
      per_second_(static_cast<float>(1.0 / (exposure.exposure_us * 1e-6 * exposure.iso / 100))) {
  const std::array<float, 3> by_calibration = measured_full(like, response);
  double mean_range = 0;
  for (std::size_t y = 0; y < 2; ++y) {
    for (std::size_t x = 0; x < 2; ++x) {
      const float range = like.white - like.black[y][x];
      const int site = like.cfa.site[y][x];
      const auto channel = static_cast<std::size_t>(site == 3 ? 1 : site);
      const float full = like.full[channel] > 0        ? like.full[channel]
                         : by_calibration[channel] > 0 ? by_calibration[channel]
                                                       : like.white;
      saturated_from_[y][x] =
          like.black[y][x] + static_cast<float>(kSaturatedFrom) * (full - like.black[y][x]);
      per_count_[y][x] = 1 / range;
      linearity_a_[y][x] = static_cast<float>(response.linearity[channel][0]);
      linearity_b_[y][x] = static_cast<float>(response.linearity[channel][1]);
      mean_range += range / 4.0;
    }
  }
  // s counts of light have variance s / gain.
  const double reading_per_count = static_cast<double>(per_second_) / mean_range;
  const double still = response.read_noise_counts * response.read_noise_counts;
  noise_.per_reading = reading_per_count / response.electrons_per_count;
  noise_.floor = reading_per_count * reading_per_count * still;
  noise_.shared = dark != nullptr ? noise_.floor : 0;
}

void merge_exposures(std::span<const View<const float>> readings, std::span<const NoiseModel> noise,
                     View<float> out) {
  for (int y = 0; y < out.height(); ++y) {
    for (int x = 0; x < out.width(); ++x) {
      double light = 0, light_weight = 0;
      bool is_full = false;
      for (std::size_t i = 0; i < readings.size(); ++i) {
        const float r = readings[i](x, y);
        is_full = is_full || r == std::numeric_limits<float>::infinity();
        if (!std::isfinite(r)) continue;
        light += static_cast<double>(r) / noise[i].per_reading;
        light_weight += 1 / noise[i].per_reading;
      }
      if (light_weight == 0) {
        out(x, y) =
            is_full ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
        continue;
      }
      double sum = 0, weight = 0;
      for (std::size_t i = 0; i < readings.size(); ++i) {
        const float r = readings[i](x, y);
        if (!std::isfinite(r)) continue;
        const double w = 1 / noise[i].variance(light / light_weight);
        sum += w * static_cast<double>(r);
        weight += w;
      }
      out(x, y) = static_cast<float>(sum / weight);
    }
  }
}

void Radiometry::read(View<const std::uint16_t> counts, Rect tile, View<float> out) const {
  for (int y = tile.y0; y < tile.y1; ++y) {
    const auto j = static_cast<std::size_t>(y & 1);
    const RadiometryRow row = {counts.row(y) + tile.x0,
                               dark_.empty() ? nullptr : dark_.row(y) + tile.x0,
                               {black_[j][0], black_[j][1]},
                               {saturated_from_[j][0], saturated_from_[j][1]},
                               {per_count_[j][0], per_count_[j][1]},
                               {linearity_a_[j][0], linearity_a_[j][1]},
                               {linearity_b_[j][0], linearity_b_[j][1]},
                               per_second_};
    HWY_DYNAMIC_DISPATCH(read_row)(row, out.row(y - tile.y0), static_cast<std::size_t>(tile.width()));
  }
}

}  // namespace weft
#endif
