// SPDX-License-Identifier: Apache-2.0
// Readings over strength of a vector of pixels and which of them count; compiled once for every SIMD target.

#if defined(WEFT_SOLVER_KERNELS_GATHER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_SOLVER_KERNELS_GATHER_INL_H
#undef WEFT_SOLVER_KERNELS_GATHER_INL_H
#else
#define WEFT_SOLVER_KERNELS_GATHER_INL_H
#endif

#include <hwy/highway.h>
// math-inl.h comes after highway.h.
#include <hwy/contrib/math/math-inl.h>

#include "core/rig/light_field.h"
#include "core/solve/solve_record.h"
#include "solver/in_double/pixel.h"
#include "solver/kernels/row_task.h"
#include "solver/kernels/vector-inl.h"
#include "solver/method.h"

HWY_BEFORE_NAMESPACE();
namespace weft::solver {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A quantity of RowPoints at the vector of columns that starts at x: vectors never straddle a cell.
struct Along {
  std::size_t cell;
  V offset;

  Along(D d, std::size_t x)
      : cell(x / LightField::kCell),
        offset(hn::Iota(d, static_cast<float>(x % static_cast<std::size_t>(LightField::kCell)))) {}
  HWY_INLINE V at(D d, RowLinePointer line) const {
    return hn::MulAdd(offset, hn::Set(d, line.step[cell]), hn::Set(d, line.value[cell]));
  }
};

// The value of an even and an odd column, alternating from column x.
HWY_INLINE V alternate(D d, std::size_t x, float even, float odd) {
  if (hn::Lanes(d) == 1) return hn::Set(d, (x & 1) != 0 ? odd : even);
  return hn::OddEven(hn::Set(d, odd), hn::Set(d, even));
}

struct LightHere {
  Vector3 l;
  V inverse_shape;  // 1 / (lobe * gain / d^2): 1 / e without flux and the gain of the channel
  V cosine;         // of the angle from the LED's aim; positive where the LED shines
};

HWY_INLINE LightHere light_here(D d, const RowLight& light, V x_mm, V y_mm, V gain) {
  const Vector3 p = {hn::Set(d, light.position[0]), hn::Set(d, light.position[1]),
                     hn::Set(d, light.position[2])};
  const V one = hn::Set(d, 1.0f);
  if (light.distant) return {p, one, one};
  const Vector3 to_led = {hn::Sub(p.x, x_mm), hn::Sub(p.y, y_mm), p.z};
  const V d2 = dot(to_led, to_led);
  const V inverse_d = reciprocal_sqrt(d, d2);
  LightHere here;
  here.l = scaled(to_led, inverse_d);
  if (light.mu == 0) {
    here.cosine = one;
    here.inverse_shape = hn::Div(d2, gain);
    return here;
  }
  const Vector3 back = {hn::Set(d, light.against_aim[0]), hn::Set(d, light.against_aim[1]),
                        hn::Set(d, light.against_aim[2])};
  here.cosine = dot(here.l, back);
  V lobe = here.cosine;
  if (light.mu != 1) lobe = hn::Exp(d, hn::Mul(hn::Set(d, light.mu), hn::Log(d, hn::Max(lobe, hn::Zero(d)))));
  here.inverse_shape = hn::Div(d2, hn::Mul(lobe, gain));
  return here;
}

// Where the quantities of light k lie in the scratch of a row.
class Scratch {
 public:
  Scratch(D d, float* data, std::size_t lights)
      : d_(d), data_(data), lanes_(hn::Lanes(d)), sorted_(at(lights, kDirection)) {}

  HWY_INLINE void store(std::size_t k, Vector3 l, V light, V inverse_e) const {
    hn::StoreU(l.x, d_, at(k, kDirection));
    hn::StoreU(l.y, d_, at(k, kDirection + 1));
    hn::StoreU(l.z, d_, at(k, kDirection + 2));
    hn::StoreU(light, d_, at(k, kLight));
    hn::StoreU(inverse_e, d_, at(k, kInverseE));
  }
  HWY_INLINE void store_light(std::size_t k, V light) const { hn::StoreU(light, d_, at(k, kLight)); }
  HWY_INLINE void store_inverse_e(std::size_t k, V v) const { hn::StoreU(v, d_, at(k, kInverseE)); }
  HWY_INLINE void store_plane(std::size_t k, std::size_t plane, V x) const {
    hn::StoreU(x, d_, at(k, kPlane + plane));
  }
  HWY_INLINE void store_shadowed(std::size_t k, V light) const {
    hn::StoreU(light, d_, at(k, kShadowedLight));
  }
  HWY_INLINE void store_weight(std::size_t k, V weight) const { hn::StoreU(weight, d_, at(k, kWeight)); }
  HWY_INLINE Vector3 direction(std::size_t k) const {
    return {load(k, kDirection), load(k, kDirection + 1), load(k, kDirection + 2)};
  }
  HWY_INLINE V light(std::size_t k) const { return load(k, kLight); }
  HWY_INLINE V inverse_e(std::size_t k) const { return load(k, kInverseE); }
  HWY_INLINE V plane(std::size_t k, std::size_t p) const { return load(k, kPlane + p); }
  // What the shadow mask left out, else minus infinity.
  HWY_INLINE V shadowed(std::size_t k) const { return load(k, kShadowedLight); }
  HWY_INLINE V weight(std::size_t k) const { return load(k, kWeight); }
  HWY_INLINE float* sorted(std::size_t rank) const { return sorted_ + rank * lanes_; }

 private:
  enum Slot : std::size_t {
    kDirection = 0,
    kLight = 3,
    kInverseE = 4,
    kPlane = 5,
    kShadowedLight = 8,
    kWeight = 9,
    kSlots = kRowScratchSlots
  };
  HWY_INLINE float* at(std::size_t k, std::size_t slot) const { return data_ + (k * kSlots + slot) * lanes_; }
  HWY_INLINE V load(std::size_t k, std::size_t slot) const { return hn::LoadU(d_, at(k, slot)); }

  D d_;
  float* data_;
  std::size_t lanes_;
  float* sorted_;
};

// The brightest readings seen so far, in falling order: four in registers, more of them (many lights) in
// memory.
class Brightest {
 public:
  Brightest(D d, const Scratch& scratch, std::size_t count)
      : d_(d),
        scratch_(&scratch),
        count_(count),
        first_(hn::Neg(hn::Inf(d))),
        second_(first_),
        third_(first_),
        fourth_(first_) {
    if (count_ > 4) {
      for (std::size_t i = 0; i < count_; ++i) hn::StoreU(first_, d_, scratch.sorted(i));
    }
  }

  HWY_INLINE void add(V v) {
    if (count_ > 4) {
      for (std::size_t i = 0; i < count_; ++i) {
        const V kept = hn::LoadU(d_, scratch_->sorted(i));
        hn::StoreU(hn::Max(kept, v), d_, scratch_->sorted(i));
        v = hn::Min(kept, v);
      }
      return;
    }
    insert(first_, v);
    insert(second_, v);
    insert(third_, v);
    insert(fourth_, v);
  }
  HWY_INLINE V ranked(std::size_t index) const {
    if (count_ > 4) return hn::LoadU(d_, scratch_->sorted(index));
    return index == 0 ? first_ : index == 1 ? second_ : index == 2 ? third_ : fourth_;
  }

 private:
  static HWY_INLINE void insert(V& kept, V& v) {
    const V larger = hn::Max(kept, v);
    v = hn::Min(kept, v);
    kept = larger;
  }

  D d_;
  const Scratch* scratch_;
  std::size_t count_;
  V first_, second_, third_, fourth_;
};

// Normal equations and what tells whether they may stand.
template <std::size_t kPlanes>
struct Sums {
  Symmetric g;
  Vector3 rhs;
  Vector3 plane_rhs[3];
  V count;

  explicit Sums(D d) : g(zero_matrix(d)), rhs(zero_vector(d)), plane_rhs{rhs, rhs, rhs}, count(hn::Zero(d)) {}
};

// What a vector of columns has in common, whichever way it is solved.
struct Columns {
  std::size_t x;
  Along along;
  V x_mm, y_mm;

  Columns(D d, const RowTask& task, std::size_t first)
      : x(first),
        along(d, first),
        x_mm(task.points->x_mm.value != nullptr ? along.at(d, task.points->x_mm) : hn::Zero(d)),
        y_mm(task.points->x_mm.value != nullptr ? along.at(d, task.points->y_mm) : hn::Zero(d)) {}
};

// 1 / gain of each plane of a vector of columns; ones where the calibration has no gains.
template <std::size_t kPlanes>
struct InverseGains {
  V of_plane[kPlanes];

  HWY_INLINE InverseGains(D d, const RowTask& task, const Columns& columns) {
    const RowPoints& points = *task.points;
    const auto gain_of = [&](std::size_t channel) { return columns.along.at(d, points.gain_rgb[channel]); };
    for (std::size_t p = 0; p < kPlanes; ++p) {
      if (points.led_gain.empty()) {
        of_plane[p] = hn::Set(d, 1.0f);
      } else if constexpr (kPlanes == 3) {
        of_plane[p] = reciprocal(d, gain_of(p));
      } else {
        of_plane[p] = reciprocal(d, hn::Lanes(d) == 1
                                        ? gain_of(task.channel[columns.x & 1])
                                        : hn::OddEven(gain_of(task.channel[1]), gain_of(task.channel[0])));
      }
    }
  }
};

// 1 / E of a light in one plane, whose normal faces it.
template <std::size_t kPlanes>
HWY_INLINE V inverse_irradiance(D d, const RowTask& task, const Columns& columns,
                                const InverseGains<kPlanes>& inverse_gain, const RowLight& light,
                                V inverse_shape, std::size_t p) {
  V inverse_flux;
  if constexpr (kPlanes == 1) {
    inverse_flux =
        alternate(d, columns.x, light.inverse_flux[task.channel[0]], light.inverse_flux[task.channel[1]]);
  } else {
    inverse_flux = hn::Set(d, light.inverse_flux[p]);
  }
  return hn::Mul(inverse_shape, hn::Mul(inverse_flux, inverse_gain.of_plane[p]));
}

// Over all lights.
struct Extremes {
  V darkest, brightest, least_cosine;

  HWY_INLINE explicit Extremes(D d)
      : darkest(hn::Inf(d)), brightest(hn::Neg(darkest)), least_cosine(hn::Set(d, 1.0f)) {}
};

// Whether every reading of every lane counts: none is missing, saturated or behind a LED, none is dark enough
// to be taken for a shadow, the first stands out of the noise. A value that is not finite shows in the sums.
template <std::size_t kPlanes>
HWY_INLINE bool all_count(D d, const RowTask& task, const Columns& columns, const Sums<kPlanes>& sums,
                          const Extremes& extremes) {
  M all = hn::Lt(hn::Abs(hn::Add(sums.rhs.x, hn::Add(sums.rhs.y, sums.rhs.z))), hn::Inf(d));
  all = hn::And(all, hn::Gt(extremes.least_cosine, hn::Zero(d)));
  const V first_reading = hn::LoadU(d, task.readings[0] + columns.x);
  all = hn::And(all, kPlanes == 1 ? hn::Gt(first_reading, hn::Set(d, task.dark_reading))
                                  : hn::Gt(extremes.brightest, hn::Zero(d)));
  if (task.shadow_mask) {
    const V shadow_share = hn::Set(d, static_cast<float>(kShadowShare));
    all = hn::And(all, hn::Ge(extremes.darkest, hn::Mul(shadow_share, extremes.brightest)));
  }
  return hn::AllTrue(d, all);
}

// Readings over strength of all lights, kept in `scratch`, and their normal equations as if every one
// counted. Returns whether that is so.
template <std::size_t kPlanes>
HWY_INLINE bool gather(D d, const RowTask& task, const Scratch& scratch, const Columns& columns,
                       Sums<kPlanes>& sums) {
  const RowPoints& points = *task.points;
  const bool has_gains = !points.led_gain.empty();  // read once: no store of a vector can change it
  const InverseGains<kPlanes> inverse_gain(d, task, columns);
  Extremes extremes(d);
  for (std::size_t k = 0; k < task.light_count; ++k) {
    const RowLight& light = task.lights[k];
    const V led_gain = has_gains ? columns.along.at(d, points.led_gain[k]) : hn::Set(d, 1.0f);
    const LightHere here = light_here(d, light, columns.x_mm, columns.y_mm, led_gain);
    V light_sum = hn::Zero(d), inverse_e = light_sum;
    for (std::size_t p = 0; p < kPlanes; ++p) {
      const V r = hn::LoadU(d, task.readings[k * kPlanes + p] + columns.x);
      inverse_e = inverse_irradiance(d, task, columns, inverse_gain, light, here.inverse_shape, p);
      const V ratio = hn::Mul(r, inverse_e);
      if constexpr (kPlanes == 1) {
        light_sum = ratio;
      } else {
        light_sum = hn::MulAdd(hn::Set(d, task.plane_weight[p]), ratio, light_sum);
        scratch.store_plane(k, p, ratio);
        add_scaled(sums.plane_rhs[p], ratio, here.l);
      }
    }
    scratch.store(k, here.l, light_sum, inverse_e);
    extremes.darkest = hn::Min(extremes.darkest, light_sum);
    extremes.brightest = hn::Max(extremes.brightest, light_sum);
    extremes.least_cosine = hn::Min(extremes.least_cosine, here.cosine);
    add_outer(sums.g, here.l, here.l);
    add_scaled(sums.rhs, light_sum, here.l);
  }
  sums.count = hn::Set(d, static_cast<float>(task.light_count));
  return all_count(d, task, columns, sums, extremes);
}

using Status = hn::Vec<hn::RebindToSigned<D>>;

HWY_INLINE void mark(Status& status, M where, std::uint16_t bit) {
  const hn::RebindToSigned<D> di;
  status = hn::Or(status, hn::IfThenElseZero(hn::RebindMask(di, where), hn::Set(di, bit)));
}

// Leaves only readings that can be used in `scratch`, the others become minus infinity, and marks in `status`
// why. Returns the lanes that have a reading which stands out of the noise.
template <std::size_t kPlanes>
HWY_INLINE M leave_out_unusable(D d, const RowTask& task, const Scratch& scratch, const Columns& columns,
                                Brightest& brightest, Status& status) {
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f), infinity = hn::Inf(d),
          minus_infinity = hn::Neg(infinity);
  const M no = no_lane(d);
  M saturated = no, invalid = no, unlit = no, bright = no;
  for (std::size_t k = 0; k < task.light_count; ++k) {
    M missing = no, full = no, in_shadow = no, stands_out = no;
    for (std::size_t p = 0; p < kPlanes; ++p) {
      const V r = hn::LoadU(d, task.readings[k * kPlanes + p] + columns.x);
      full = hn::Or(full, hn::Eq(r, infinity));
      missing = hn::Or(missing, hn::IsNaN(r));
      in_shadow = hn::Or(in_shadow, hn::Eq(r, minus_infinity));
      if constexpr (kPlanes == 1) stands_out = hn::Gt(r, hn::Set(d, task.dark_reading));
    }
    const V light_sum = scratch.light(k);
    if constexpr (kPlanes == 3) stands_out = hn::Gt(light_sum, zero);
    const V cosine = light_here(d, task.lights[k], columns.x_mm, columns.y_mm, one).cosine;
    full = hn::AndNot(missing, full);
    const M unreadable = hn::Or(missing, full);
    const M behind = hn::AndNot(unreadable, hn::Or(in_shadow, hn::Not(hn::Gt(cosine, zero))));
    const M usable = hn::Not(hn::Or(behind, unreadable));
    invalid = hn::Or(invalid, missing);
    saturated = hn::Or(saturated, full);
    unlit = hn::Or(unlit, behind);
    bright = hn::Or(bright, hn::And(usable, stands_out));
    const V kept = hn::IfThenElse(usable, light_sum, minus_infinity);
    scratch.store_light(k, kept);
    if (task.shadow_mask) brightest.add(kept);
  }
  mark(status, invalid, kInvalidReading);
  mark(status, saturated, kSaturated);
  mark(status, unlit, kShadowed);
  return bright;
}

// Readings below this are in shadow. The kLeastKept brightest never are.
HWY_INLINE V shadow_threshold(D d, const RowTask& task, const Brightest& brightest) {
  if (!task.shadow_mask) return hn::Neg(hn::Inf(d));
  const V shadow_share = hn::Set(d, static_cast<float>(kShadowShare));
  return hn::Min(hn::Mul(shadow_share, brightest.ranked(task.bright_index)),
                 brightest.ranked(kLeastKept - 1));
}

// The normal equations of the readings from `threshold` on. The others become minus infinity and are put
// beside. Returns the lanes that have others.
template <std::size_t kPlanes>
HWY_INLINE M leave_out_shadow(D d, const RowTask& task, const Scratch& scratch, V threshold,
                              Sums<kPlanes>& sums) {
  const V one = hn::Set(d, 1.0f), minus_infinity = hn::Neg(hn::Inf(d));
  sums = Sums<kPlanes>(d);
  M any = no_lane(d);
  for (std::size_t k = 0; k < task.light_count; ++k) {
    const V light_sum = scratch.light(k);
    const M usable = hn::Gt(light_sum, minus_infinity);
    const M keep = hn::And(usable, hn::Ge(light_sum, threshold));
    any = hn::Or(any, hn::AndNot(keep, usable));
    sums.count = hn::Add(sums.count, hn::IfThenElseZero(keep, one));
    scratch.store_light(k, hn::IfThenElse(keep, light_sum, minus_infinity));
    scratch.store_shadowed(k, hn::IfThenElse(keep, minus_infinity, light_sum));
    const Vector3 l = scratch.direction(k);
    add_outer(sums.g, masked(keep, l), l);
    add_scaled(sums.rhs, hn::IfThenElseZero(keep, light_sum), l);
    if constexpr (kPlanes == 3) {
      for (std::size_t p = 0; p < 3; ++p)
        add_scaled(sums.plane_rhs[p], hn::IfThenElseZero(keep, scratch.plane(k, p)), l);
    }
  }
  return any;
}

struct Selection {
  M again;     // lanes that must be solved again in double
  M shadowed;  // the mask left something out
};

// The normal equations again, of the readings that can be used and that the shadow mask keeps.
template <std::size_t kPlanes>
HWY_INLINE Selection select(D d, const RowTask& task, const Scratch& scratch, const Columns& columns,
                            Sums<kPlanes>& sums, Status& status) {
  Brightest brightest(d, scratch, task.bright_rank);
  const M bright = leave_out_unusable<kPlanes>(d, task, scratch, columns, brightest, status);
  const V threshold = shadow_threshold(d, task, brightest);
  const M shadowed = leave_out_shadow(d, task, scratch, threshold, sums);
  // The mask stands only while enough is left; without anything bright there is nothing to tell shadow by.
  const V determinant = inverted(d, sums.g).determinant;
  const M too_little = hn::Not(hn::Gt(determinant, hn::Set(d, static_cast<float>(kLeastMaskedDeterminant))));
  const M too_few = hn::Lt(sums.count, hn::Set(d, 3.0f));
  return {hn::Or(hn::Not(bright), hn::Or(hn::And(shadowed, too_little), too_few)), shadowed};
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();

#endif
