// SPDX-License-Identifier: Apache-2.0
// The row kernels of linear.cpp, compiled once for every SIMD target.

#include <hwy/cache_control.h>
#include <hwy/highway.h>
// math-inl.h comes after highway.h.
#include <hwy/contrib/math/math-inl.h>

#include "core/solve_record.h"
#include "core/vec.h"
#include "solver/kernels/linear_row.h"
#include "solver/kernels/vector-inl.h"
#include "solver/method.h"
#include "solver/reference/pixel.h"

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
  here.l = {hn::Mul(to_led.x, inverse_d), hn::Mul(to_led.y, inverse_d), hn::Mul(to_led.z, inverse_d)};
  if (light.mu == 0) {
    here.cosine = one;
    here.inverse_shape = hn::Mul(d2, reciprocal(d, gain));
    return here;
  }
  const Vector3 aim = {hn::Set(d, light.aim[0]), hn::Set(d, light.aim[1]), hn::Set(d, light.aim[2])};
  here.cosine = hn::Neg(dot(here.l, aim));
  V lobe = here.cosine;
  if (light.mu != 1) lobe = hn::Exp(d, hn::Mul(hn::Set(d, light.mu), hn::Log(d, hn::Max(lobe, hn::Zero(d)))));
  here.inverse_shape = hn::Mul(d2, reciprocal(d, hn::Mul(lobe, gain)));
  return here;
}

// Where the quantities of light k lie in the scratch of a row.
class Scratch {
 public:
  Scratch(D d, float* data, std::size_t lights)
      : d_(d), data_(data), lanes_(hn::Lanes(d)), sorted_(data + lights * 8 * lanes_) {}

  HWY_INLINE void store(std::size_t k, Vector3 l, V light, V inverse_e) const {
    float* p = data_ + k * 8 * lanes_;
    hn::StoreU(l.x, d_, p);
    hn::StoreU(l.y, d_, p + lanes_);
    hn::StoreU(l.z, d_, p + 2 * lanes_);
    hn::StoreU(light, d_, p + 3 * lanes_);
    hn::StoreU(inverse_e, d_, p + 4 * lanes_);
  }
  HWY_INLINE void store_light(std::size_t k, V light) const {
    hn::StoreU(light, d_, data_ + (k * 8 + 3) * lanes_);
  }
  HWY_INLINE void store_plane(std::size_t k, std::size_t plane, V x) const {
    hn::StoreU(x, d_, data_ + (k * 8 + 5 + plane) * lanes_);
  }
  HWY_INLINE Vector3 direction(std::size_t k) const { return {load(k, 0), load(k, 1), load(k, 2)}; }
  HWY_INLINE V light(std::size_t k) const { return load(k, 3); }
  HWY_INLINE V inverse_e(std::size_t k) const { return load(k, 4); }
  HWY_INLINE V plane(std::size_t k, std::size_t p) const { return load(k, 5 + p); }
  HWY_INLINE float* sorted(std::size_t rank) const { return sorted_ + rank * lanes_; }

 private:
  HWY_INLINE V load(std::size_t k, std::size_t what) const {
    return hn::LoadU(d_, data_ + (k * 8 + what) * lanes_);
  }

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

  explicit Sums(D d)
      : g(zero_matrix(d)),
        rhs{hn::Zero(d), hn::Zero(d), hn::Zero(d)},
        plane_rhs{rhs, rhs, rhs},
        count(hn::Zero(d)) {}
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

// Readings over strength of all lights, kept in `scratch`, and their normal equations as if every one
// counted. Returns whether that holds for every lane: no reading is missing, saturated or behind a LED, none
// is dark enough to be taken for a shadow, some stand out of the noise. A value that is not finite shows in
// the sums.
template <std::size_t kPlanes>
HWY_INLINE bool gather(D d, const RowTask& task, const Scratch& scratch, const Columns& columns,
                       Sums<kPlanes>& sums) {
  const V one = hn::Set(d, 1.0f), infinity = hn::Inf(d);
  const RowPoints& points = *task.points;
  const bool gains = !points.led_gain.empty();
  V inverse_gain[kPlanes];  // of each plane
  for (std::size_t p = 0; p < kPlanes; ++p) {
    inverse_gain[p] = one;
    if (!gains) continue;
    const auto gain_of = [&](std::size_t channel) { return columns.along.at(d, points.gain_rgb[channel]); };
    if constexpr (kPlanes == 1) {
      const V gain = hn::Lanes(d) == 1 ? gain_of(task.channel[columns.x & 1])
                                       : hn::OddEven(gain_of(task.channel[1]), gain_of(task.channel[0]));
      inverse_gain[p] = reciprocal(d, gain);
    } else {
      inverse_gain[p] = reciprocal(d, gain_of(p));
    }
  }
  V darkest = infinity, brightest = hn::Neg(infinity), brightest_reading = brightest, least_cosine = one;
  for (std::size_t k = 0; k < task.light_count; ++k) {
    const RowLight& light = task.lights[k];
    const LightHere here = light_here(d, light, columns.x_mm, columns.y_mm,
                                      gains ? columns.along.at(d, points.led_gain[k]) : one);
    V light_sum = hn::Zero(d), inverse_e = light_sum;
    for (std::size_t p = 0; p < kPlanes; ++p) {
      const V r = hn::LoadU(d, task.readings[k * kPlanes + p] + columns.x);
      V inverse_flux;
      if constexpr (kPlanes == 1) {
        inverse_flux =
            alternate(d, columns.x, light.inverse_flux[task.channel[0]], light.inverse_flux[task.channel[1]]);
      } else {
        inverse_flux = hn::Set(d, light.inverse_flux[p]);
      }
      inverse_e = hn::Mul(here.inverse_shape, hn::Mul(inverse_flux, inverse_gain[p]));
      const V ratio = hn::Mul(r, inverse_e);
      if constexpr (kPlanes == 1) {
        light_sum = ratio;
        brightest_reading = hn::Max(brightest_reading, r);
      } else {
        light_sum = hn::MulAdd(hn::Set(d, static_cast<float>(kLuminance[p])), ratio, light_sum);
        scratch.store_plane(k, p, ratio);
        add_scaled(sums.plane_rhs[p], ratio, here.l);
      }
    }
    scratch.store(k, here.l, light_sum, inverse_e);
    darkest = hn::Min(darkest, light_sum);
    brightest = hn::Max(brightest, light_sum);
    least_cosine = hn::Min(least_cosine, here.cosine);
    add_outer(sums.g, here.l, here.l);
    add_scaled(sums.rhs, light_sum, here.l);
  }
  sums.count = hn::Set(d, static_cast<float>(task.light_count));
  M all = hn::Lt(hn::Abs(hn::Add(sums.rhs.x, hn::Add(sums.rhs.y, sums.rhs.z))), infinity);
  all = hn::And(all, hn::Gt(least_cosine, hn::Zero(d)));
  all = hn::And(all, kPlanes == 1 ? hn::Gt(brightest_reading, hn::Set(d, task.dark_reading))
                                  : hn::Gt(brightest, hn::Zero(d)));
  if (task.shadow_mask) {
    all = hn::And(all, hn::Ge(darkest, hn::Mul(hn::Set(d, static_cast<float>(kShadowShare)), brightest)));
  }
  return hn::AllTrue(d, all);
}

using Status = hn::Vec<hn::RebindToSigned<D>>;

HWY_INLINE void mark(Status& status, M where, std::uint16_t bit) {
  const hn::RebindToSigned<D> di;
  status = hn::Or(status, hn::IfThenElseZero(hn::RebindMask(di, where), hn::Set(di, bit)));
}

// The normal equations again, of the readings that can be used and that the shadow mask keeps. In `scratch`,
// readings that were left out become minus infinity. Returns the lanes that must be solved again in double.
template <std::size_t kPlanes>
HWY_INLINE M select(D d, const RowTask& task, const Scratch& scratch, const Columns& columns,
                    Sums<kPlanes>& sums, Status& status) {
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f), infinity = hn::Inf(d),
          minus_infinity = hn::Neg(infinity);
  const M no = hn::Lt(one, zero);
  M saturated = no, invalid = no, unlit = no, bright = no;
  Brightest brightest(d, scratch, task.bright_rank);
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
  V threshold = minus_infinity;
  if (task.shadow_mask) {
    threshold =
        hn::Min(hn::Mul(hn::Set(d, static_cast<float>(kShadowShare)), brightest.ranked(task.bright_index)),
                brightest.ranked(kLeastKept - 1));
  }
  sums = Sums<kPlanes>(d);
  M any_dropped = no;
  for (std::size_t k = 0; k < task.light_count; ++k) {
    const V light_sum = scratch.light(k);
    const M usable = hn::Gt(light_sum, minus_infinity);
    const M keep = hn::And(usable, hn::Ge(light_sum, threshold));
    any_dropped = hn::Or(any_dropped, hn::AndNot(keep, usable));
    sums.count = hn::Add(sums.count, hn::IfThenElseZero(keep, one));
    scratch.store_light(k, hn::IfThenElse(keep, light_sum, minus_infinity));
    const Vector3 l = scratch.direction(k);
    add_outer(sums.g,
              {hn::IfThenElseZero(keep, l.x), hn::IfThenElseZero(keep, l.y), hn::IfThenElseZero(keep, l.z)},
              l);
    add_scaled(sums.rhs, hn::IfThenElseZero(keep, light_sum), l);
    if constexpr (kPlanes == 3) {
      for (std::size_t p = 0; p < 3; ++p) {
        add_scaled(sums.plane_rhs[p], hn::IfThenElseZero(keep, scratch.plane(k, p)), l);
      }
    }
  }
  mark(status, invalid, kInvalidReading);
  mark(status, saturated, kSaturated);
  mark(status, hn::Or(unlit, any_dropped), kShadowed);
  mark(status, hn::Eq(sums.count, hn::Set(d, 3.0f)), kZeroDof);
  // The mask stands only while enough is left; without anything bright there is nothing to tell shadow by.
  const V determinant = inverted(d, sums.g).determinant;
  const M too_little = hn::Not(hn::Gt(determinant, hn::Set(d, static_cast<float>(kLeastMaskedDeterminant))));
  return hn::Or(hn::Not(bright),
                hn::Or(hn::And(any_dropped, too_little), hn::Lt(sums.count, hn::Set(d, 3.0f))));
}

// Solution, residuals and covariance from the normal equations. `kSelected` says that some readings are left
// out (minus infinity in `scratch`); without any, both ways take the same steps to the same bits.
template <std::size_t kPlanes, bool kSelected>
HWY_INLINE bool finish(D d, const RowTask& task, const Scratch& scratch, std::size_t x,
                       const Sums<kPlanes>& sums, M again, Status status) {
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f), minus_infinity = hn::Neg(hn::Inf(d));
  const Inverse inverse = inverted(d, sums.g);
  const Vector3 b = times(inverse.matrix, sums.rhs);
  const V rho2 = dot(b, b);
  const V inverse_rho = hn::Div(one, hn::Sqrt(rho2));
  const V rho = hn::Mul(rho2, inverse_rho);
  const Vector3 n = {hn::Mul(b.x, inverse_rho), hn::Mul(b.y, inverse_rho), hn::Mul(b.z, inverse_rho)};
  Vector3 plane_b[3];
  if constexpr (kPlanes == 3) {
    for (std::size_t p = 0; p < 3; ++p) plane_b[p] = times(inverse.matrix, sums.plane_rhs[p]);
  }

  // What float32 cannot answer for. With rows of unit length the eigenvalues of G sum to the count and
  // determinant / minors is a lower bound of the smallest, so this catches every condition number over 30.
  const V most_condition2 = hn::Set(d, 900.0f);
  again = hn::Or(again, hn::Not(hn::Gt(hn::Mul(most_condition2, inverse.determinant),
                                       hn::Mul(sums.count, inverse.minors))));
  again = hn::Or(again, hn::Not(hn::And(hn::Gt(rho2, hn::Set(d, 1e-24f)), hn::Lt(rho2, hn::Set(d, 1e24f)))));
  mark(status, again, kSolveAgain);

  // Residuals and the covariance C = G^-1 M G^-1 of b.
  const bool modelled = kPlanes == 1 && task.has_noise;
  const V per_reading = hn::Set(d, task.noise_per_reading), floor = hn::Set(d, task.noise_floor);
  const V specular_times = hn::Set(d, static_cast<float>(kSpecularTimes));
  V residual2 = zero, most_excess = minus_infinity;
  V plane_residual2[3] = {zero, zero, zero};
  Symmetric m = zero_matrix(d);
  Vector3 shared = {zero, zero, zero};
  const auto variance_of = [&](V predicted, V inverse_e) {
    return hn::Mul(inverse_e, hn::MulAdd(per_reading, predicted, hn::Mul(floor, inverse_e)));
  };
  for (std::size_t k = 0; k < task.light_count; ++k) {
    const V light_sum = scratch.light(k);
    const M keep = hn::Gt(light_sum, minus_infinity);
    const auto kept = [&](V v) { return kSelected ? hn::IfThenElseZero(keep, v) : v; };
    const Vector3 l = scratch.direction(k);
    const V fit = dot(l, b);
    const V predicted = hn::Max(fit, zero);
    const V r = kept(hn::Sub(light_sum, fit));
    residual2 = hn::MulAdd(r, r, residual2);
    most_excess = hn::Max(most_excess, hn::NegMulAdd(specular_times, predicted, light_sum));
    if (modelled) {
      const V inverse_e = scratch.inverse_e(k);
      const V variance = kept(variance_of(predicted, inverse_e));
      add_outer(m, {hn::Mul(variance, l.x), hn::Mul(variance, l.y), hn::Mul(variance, l.z)}, l);
      add_scaled(shared, kept(inverse_e), l);
    }
    if constexpr (kPlanes == 3) {
      for (std::size_t p = 0; p < 3; ++p) {
        const V pr = kept(hn::Sub(scratch.plane(k, p), dot(l, plane_b[p])));
        plane_residual2[p] = hn::MulAdd(pr, pr, plane_residual2[p]);
      }
    }
  }
  const V margin = hn::Mul(hn::Set(d, static_cast<float>(kSpecularMargin)), rho);
  if (!hn::AllFalse(d, hn::Gt(most_excess, margin))) {
    M specular = hn::Lt(one, zero);
    for (std::size_t k = 0; k < task.light_count; ++k) {
      const V predicted = hn::Max(dot(scratch.direction(k), b), zero);
      const V excess = hn::Sub(hn::NegMulAdd(specular_times, predicted, scratch.light(k)), margin);
      const V variance = modelled ? variance_of(predicted, scratch.inverse_e(k)) : zero;
      specular = hn::Or(specular, hn::And(hn::Gt(excess, zero), hn::Gt(hn::Mul(excess, excess),
                                                                       hn::Mul(hn::Set(d, 9.0f), variance))));
    }
    mark(status, specular, kSpecular);
  }

  // Variance of the normal's angle times rho^2, and of rho.
  const V to_degrees = hn::Set(d, static_cast<float>(180 / kPi));
  const Vector3 u = times(inverse.matrix, n);
  V angle2, along_n;
  if (modelled) {
    const V s = hn::Set(d, task.noise_shared);
    const Vector3 inverse_shared = times(inverse.matrix, shared);
    const V un = dot(u, shared);
    along_n = hn::MulAdd(s, hn::Mul(un, un), dot(u, times(m, u)));
    angle2 =
        hn::MulAdd(s, dot(inverse_shared, inverse_shared), trace_of_product(d, m, squared(inverse.matrix)));
    angle2 = hn::Sub(angle2, along_n);
  } else {
    along_n = dot(n, u);
    angle2 = hn::Sub(trace(inverse.matrix), along_n);
  }
  angle2 = hn::Max(angle2, zero);
  along_n = hn::Max(along_n, zero);
  const V inverse_freedom = hn::Div(one, hn::Sub(sums.count, hn::Set(d, 3.0f)));
  const M determined = hn::Gt(sums.count, hn::Set(d, 3.0f));
  if (!modelled) angle2 = hn::Mul(angle2, hn::Mul(residual2, inverse_freedom));
  V sigma_deg = hn::Mul(to_degrees, hn::Mul(hn::Sqrt(angle2), inverse_rho));
  const V unknown = hn::Set(d, kUnknownAngleDeg);
  if (!modelled) sigma_deg = hn::IfThenElse(determined, sigma_deg, unknown);
  hn::StoreU(hn::Min(sigma_deg, unknown), d, task.sigma_normal_deg + x);
  hn::StoreU(hn::Mul(hn::Sqrt(hn::Div(residual2, sums.count)), inverse_rho), d, task.residual + x);
  hn::StoreU(n.x, d, task.normal[0] + x);
  hn::StoreU(n.y, d, task.normal[1] + x);
  hn::StoreU(n.z, d, task.normal[2] + x);
  for (std::size_t p = 0; p < kPlanes; ++p) {
    const V albedo = kPlanes == 1 ? rho : hn::Max(zero, dot(n, plane_b[p]));
    V sigma = hn::Sqrt(along_n);
    if (!modelled) {
      const V scatter2 = kPlanes == 1 ? residual2 : plane_residual2[p];
      sigma =
          hn::IfThenElse(determined, hn::Mul(sigma, hn::Sqrt(hn::Mul(scatter2, inverse_freedom))), albedo);
    }
    hn::StoreU(albedo, d, task.albedo[p] + x);
    hn::StoreU(sigma, d, task.sigma_albedo[p] + x);
  }
  const hn::Rebind<std::uint16_t, D> d16;
  hn::StoreU(hn::DemoteTo(d16, status), d16, task.status + x);
  return !hn::AllFalse(d, again);
}

// One vector of pixels. Returns whether some lane asks to be solved again.
template <std::size_t kPlanes>
HWY_INLINE bool solve_columns(D d, const RowTask& task, const Scratch& scratch, std::size_t x) {
  const Columns columns(d, task, x);
  Sums<kPlanes> sums(d);
  Status status = hn::Zero(hn::RebindToSigned<D>());
  const M no = hn::Lt(hn::Set(d, 1.0f), hn::Zero(d));
  const bool all_count = gather(d, task, scratch, columns, sums);
  if (all_count && task.light_count > 3) {
    return finish<kPlanes, false>(d, task, scratch, x, sums, no, status);
  }
  const M again = select(d, task, scratch, columns, sums, status);
  return finish<kPlanes, true>(d, task, scratch, x, sums, again, status);
}

template <std::size_t kPlanes>
bool solve_row(const RowTask& task) {
  const D d;
  const Scratch scratch(d, task.scratch, task.light_count);
  bool again = false;
  for (std::size_t x = 0; x < task.width; x += hn::Lanes(d))
    again |= solve_columns<kPlanes>(d, task, scratch, x);
  return again;
}

bool solve_mosaic_row(const RowTask& task) {
  return solve_row<1>(task);
}
bool solve_rgb_row(const RowTask& task) {
  return solve_row<3>(task);
}

// Normal equations only; see solve_bare.
void solve_bare_row(const RowTask& task) {
  // Thirty streams are as many as the machine's own prefetcher follows.
  constexpr std::size_t kAhead = 64;
  const D d;
  const V zero = hn::Zero(d);
  for (std::size_t x = 0; x < task.width; x += hn::Lanes(d)) {
    const Along along(d, x);
    const V x_mm = along.at(d, task.points->x_mm), y_mm = along.at(d, task.points->y_mm);
    Symmetric g = zero_matrix(d);
    Vector3 rhs[3] = {{zero, zero, zero}, {zero, zero, zero}, {zero, zero, zero}};
    for (std::size_t k = 0; k < task.light_count; ++k) {
      const RowLight& light = task.lights[k];
      const Vector3 to_led = {hn::Sub(hn::Set(d, light.position[0]), x_mm),
                              hn::Sub(hn::Set(d, light.position[1]), y_mm), hn::Set(d, light.position[2])};
      const V d2 = dot(to_led, to_led);
      const V inverse_d = reciprocal_sqrt(d, d2);
      const Vector3 l = {hn::Mul(to_led.x, inverse_d), hn::Mul(to_led.y, inverse_d),
                         hn::Mul(to_led.z, inverse_d)};
      add_outer(g, l, l);
      for (std::size_t c = 0; c < 3; ++c) {
        const float* reading = task.readings[k * 3 + c] + x;
        hwy::Prefetch(reading + kAhead);
        const V r = hn::LoadU(d, reading);
        add_scaled(rhs[c], hn::Mul(r, hn::Mul(d2, hn::Set(d, light.inverse_flux[c]))), l);
      }
    }
    const Symmetric inverse = inverted(d, g).matrix;
    Vector3 b[3], sum = {zero, zero, zero};
    for (std::size_t c = 0; c < 3; ++c) {
      b[c] = times(inverse, rhs[c]);
      add_scaled(sum, hn::Set(d, static_cast<float>(kLuminance[c])), b[c]);
    }
    const V inverse_rho = reciprocal_sqrt(d, dot(sum, sum));
    const Vector3 n = {hn::Mul(sum.x, inverse_rho), hn::Mul(sum.y, inverse_rho), hn::Mul(sum.z, inverse_rho)};
    hn::Stream(n.x, d, task.normal[0] + x);
    hn::Stream(n.y, d, task.normal[1] + x);
    hn::Stream(n.z, d, task.normal[2] + x);
    for (std::size_t c = 0; c < 3; ++c) hn::Stream(dot(n, b[c]), d, task.albedo[c] + x);
  }
  hwy::FlushStream();
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();
