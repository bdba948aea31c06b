// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/lobe_rows.h"

#include <algorithm>
#include <limits>

#include "solver/kernels/rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/reflectance/lobe_rows.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first.
#include <hwy/highway.h>

#include "solver/kernels/gather-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft::solver {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE void store_lanes(D d, Vector3 v, LobeBlock::Lanes3& into, std::size_t at) {
  hn::StoreU(v.x, d, into.x.data() + at);
  hn::StoreU(v.y, d, into.y.data() + at);
  hn::StoreU(v.z, d, into.z.data() + at);
}

HWY_INLINE Vector3 unit_of(D d, Vector3 v) {
  return scaled(v, hn::Div(hn::Set(d, 1.0F), hn::Sqrt(dot(v, v))));
}

// A reading over its strength, times `per_unit`; the sum of planes each with its weight.
template <std::size_t kPlanes>
HWY_INLINE V reading_over_strength(D d, const RowTask& task, const Columns& columns, std::size_t k,
                                   V inverse_shape, V per_unit, const InverseGains<kPlanes>& inverse_gain,
                                   V& variance) {
  V value = hn::Zero(d);
  for (std::size_t p = 0; p < kPlanes; ++p) {
    const V r = hn::LoadU(d, task.readings[k * kPlanes + p] + columns.x);
    const V inverse_e = hn::Mul(
        per_unit, inverse_irradiance(d, task, columns, inverse_gain, task.lights[k], inverse_shape, p));
    const V ratio = hn::Mul(r, inverse_e);
    if constexpr (kPlanes == 1) {
      value = ratio;
      if (task.has_noise) {
        const V noise = hn::MulAdd(hn::Set(d, task.noise_per_reading), hn::Max(r, hn::Zero(d)),
                                   hn::Set(d, task.noise_floor));
        variance = hn::Mul(noise, hn::Mul(inverse_e, inverse_e));
      }
    } else {
      value = hn::MulAdd(hn::Set(d, task.plane_weight[p]), ratio, value);
    }
  }
  return value;
}

// One state of the films for a vector of columns. Returns how many readings have a weight.
template <std::size_t kPlanes>
HWY_INLINE V gather_state(D d, const RowTask& task, float per_unit, const Columns& columns, Vector3 view,
                          LobeBlock::Light* lights, std::size_t at) {
  const RowPoints& points = *task.points;
  const bool has_gains = !points.led_gain.empty();
  const InverseGains<kPlanes> inverse_gain(d, task, columns);
  const V one = hn::Set(d, 1.0F), zero = hn::Zero(d), infinity = hn::Inf(d);
  const V share = hn::Set(d, static_cast<float>(kLobeModelShare)),
          least = hn::Set(d, static_cast<float>(kLeastModelled));
  Brightest brightest(d, Scratch(d, task.scratch, task.light_count), task.bright_rank);
  for (std::size_t k = 0; k < task.light_count; ++k) {
    LobeBlock::Light& into = lights[k];
    const V led_gain = has_gains ? columns.along.at(d, points.led_gain[k]) : one;
    const LightHere here = light_here(d, task.lights[k], columns.x_mm, columns.y_mm, led_gain);
    V variance = zero;
    const V value = reading_over_strength<kPlanes>(d, task, columns, k, here.inverse_shape,
                                                   hn::Set(d, per_unit), inverse_gain, variance);
    const V modelled = hn::Mul(share, hn::Max(value, least));
    const M counts = hn::And(hn::Gt(here.cosine, zero), hn::Lt(hn::Abs(value), infinity));
    brightest.add(hn::IfThenElse(counts, value, hn::Neg(infinity)));
    const V root_weight = hn::Div(one, hn::Sqrt(hn::MulAdd(modelled, modelled, variance)));
    const Vector3 sum = {hn::Add(here.l.x, view.x), hn::Add(here.l.y, view.y), hn::Add(here.l.z, view.z)};
    const Vector3 half = unit_of(d, sum);
    const V r = hn::Sub(one, dot(here.l, half)), r2 = hn::Mul(r, r);
    store_lanes(d, here.l, into.to_light, at);
    store_lanes(d, half, into.half, at);
    hn::StoreU(hn::Mul(hn::Mul(r2, r2), r), d, into.grazing.data() + at);
    hn::StoreU(hn::IfThenElseZero(counts, value), d, into.reading.data() + at);
    hn::StoreU(hn::IfThenElseZero(counts, root_weight), d, into.root_weight.data() + at);
  }
  const V shadow = hn::Set(d, static_cast<float>(kShadowShare));
  const V threshold = hn::Mul(shadow, brightest.ranked(task.bright_index));
  V used = zero;
  for (std::size_t k = 0; k < task.light_count; ++k) {
    LobeBlock::Light& into = lights[k];
    const M is_dark = hn::Lt(hn::LoadU(d, into.reading.data() + at), threshold);
    const V weight = hn::IfThenZeroElse(is_dark, hn::LoadU(d, into.root_weight.data() + at));
    hn::StoreU(weight, d, into.root_weight.data() + at);
    used = hn::Add(used, hn::IfThenElseZero(hn::Gt(weight, zero), one));
  }
  return used;
}

void gather_block_lanes(const LobeRowTask& task, std::size_t x, std::size_t pixels, LobeBlock& block) {
  const D d;
  const std::size_t lights = task.states[0].light_count;
  for (std::size_t at = 0; at < pixels; at += hn::Lanes(d)) {
    const Columns columns(d, task.states[0], x + at);
    Vector3 view = {hn::Zero(d), hn::Zero(d), hn::Set(d, 1.0F)};
    if (!task.is_far) {
      view =
          unit_of(d, {hn::Sub(hn::Set(d, task.camera_mm[0]), columns.x_mm),
                      hn::Sub(hn::Set(d, task.camera_mm[1]), columns.y_mm), hn::Set(d, task.camera_mm[2])});
    }
    store_lanes(d, view, block.view, at);
    V used = hn::Zero(d);
    for (std::size_t s = 0; s < task.state_count; ++s) {
      LobeBlock::Light* of_state = block.lights().data() + s * lights;
      const RowTask& state = task.states[s];
      used = hn::Add(used, task.planes == 1
                               ? gather_state<1>(d, state, task.per_unit, columns, view, of_state, at)
                               : gather_state<3>(d, state, task.per_unit, columns, view, of_state, at));
    }
    hn::StoreU(used, d, block.used.data() + at);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace weft::solver {

HWY_EXPORT(gather_block_lanes);

LobeRows::LobeRows(const TileInput& input, Sight sight, double unit)
    : input_(input), sight_(sight), unit_(unit) {
  write_row_lights(*input.field, lights_);
  scratch_.resize(row_scratch_floats(lights_.size()));
  readings_.resize(input.readings.size() + input.parallel.size());
  RowTask task;
  task.lights = lights_.data();
  task.light_count = lights_.size();
  task.points = &points_;
  task.scratch = scratch_.data();
  task.bright_rank = static_cast<std::size_t>(bright_rank(lights_.size()));
  task.bright_index = task.bright_rank - 1;
  for (std::size_t p = 0; p < 3; ++p) task.plane_weight[p] = static_cast<float>(input.plane_weights[p]);
  task.has_noise = input.planes == 1 && input.noise.has_value();
  if (task.has_noise) {
    task.noise_per_reading = static_cast<float>(input.noise->per_reading);
    task.noise_floor = static_cast<float>(input.noise->floor);
  }
  task.readings = readings_.data();
  tasks_.push_back(task);
  if (input.parallel.empty()) return;
  task.readings = readings_.data() + input.readings.size();
  tasks_.push_back(task);
}

void LobeRows::go_to_row(int y) {
  const Rect& tile = input_.tile;
  points_.read(*input_.field, tile.y0 + y, tile.x0, tile.x1);
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    const std::size_t first = input_.readings.size();
    readings_[i] = i < first ? input_.readings[i].row(y) : input_.parallel[i - first].row(y);
  }
  if (input_.planes != 1) return;
  for (RowTask& task : tasks_) {
    for (int parity = 0; parity < 2; ++parity) {
      task.channel[parity] = static_cast<std::size_t>(input_.cfa.channel_at(tile.x0 + parity, tile.y0 + y));
    }
  }
}

void LobeRows::read(int x, LobeBlock& block) const {
  LobeRowTask task;
  task.states = tasks_.data();
  task.state_count = tasks_.size();
  task.planes = input_.planes;
  task.per_unit = static_cast<float>(1 / unit_);
  task.is_far = sight_.is_far();
  const Vec3 camera = sight_.above_cloth_mm();
  task.camera_mm[0] = static_cast<float>(camera.x);
  task.camera_mm[1] = static_cast<float>(camera.y);
  task.camera_mm[2] = static_cast<float>(camera.z);
  const double shares[2] = {input_.lobe_share, kParallelLobeShare};
  for (std::size_t k = 0; k < block.lights().size(); ++k)
    block.lights()[k].lobe_share.fill(static_cast<float>(shares[k / lights_.size()]));
  for (std::size_t i = 0; i < LobeBlock::kPixels && input_.planes == 1; ++i)
    block.channel[i] = static_cast<float>(tasks_.front().channel[(static_cast<std::size_t>(x) + i) % 2] + 1);
  const int pixels = std::min(kRowGroup, input_.tile.width() - x);
  HWY_DYNAMIC_DISPATCH(gather_block_lanes)
  (task, static_cast<std::size_t>(x), static_cast<std::size_t>(pixels), block);
  block.reset();
}

}  // namespace weft::solver
#endif
