// SPDX-License-Identifier: Apache-2.0
// Weighted least squares of a vector of pixels; compiled once for every SIMD target.

#if defined(WEFT_SOLVER_KERNELS_ESTIMATE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_SOLVER_KERNELS_ESTIMATE_INL_H
#undef WEFT_SOLVER_KERNELS_ESTIMATE_INL_H
#else
#define WEFT_SOLVER_KERNELS_ESTIMATE_INL_H
#endif

#include <hwy/highway.h>

#include "solver/kernels/finish-inl.h"
#include "solver/kernels/gather-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft::solver {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Doubt carries the rounding of one round into the weights of the next, and grows it: it is left to double
// from here.
inline constexpr double kDoubtedCondition = 5;

// What is known of a vector of pixels so far. A reading in use has a weight over zero in the scratch.
struct Estimate {
  Fit fit;
  Vector3 predictor;  // the solution that the weights are predicted from
  V count;            // readings in use
  V rejected;
  M again;  // float32 cannot answer for it
};

// Variances of readings over strength, as a solution b predicts them.
class Variance {
 public:
  HWY_INLINE Variance(D d, const RowTask& task, Vector3 b)
      : b_(b),
        per_reading_(hn::Set(d, task.noise_per_reading)),
        floor_(hn::Set(d, task.noise_floor)),
        model_(hn::Mul(hn::Set(d, static_cast<float>(std::pow(model_share(task.has_noise), 2))), dot(b, b))),
        zero_(hn::Zero(d)) {}
  HWY_INLINE V at(Vector3 l, V inverse_e) const {
    const V predicted = hn::Max(zero_, dot(l, b_));
    return hn::MulAdd(inverse_e, hn::MulAdd(per_reading_, predicted, hn::Mul(floor_, inverse_e)), model_);
  }

 private:
  Vector3 b_;
  V per_reading_, floor_, model_, zero_;
};

// a . M a
HWY_INLINE V quadratic(D d, const Symmetric& m, Vector3 a) {
  const V two = hn::Set(d, 2.0f);
  const V x = hn::MulAdd(m.xx, a.x, hn::Mul(two, hn::MulAdd(m.xy, a.y, hn::Mul(m.xz, a.z))));
  const V y = hn::MulAdd(m.yy, a.y, hn::Mul(hn::Mul(two, m.yz), a.z));
  return hn::MulAdd(x, a.x, hn::MulAdd(y, a.y, hn::Mul(hn::Mul(m.zz, a.z), a.z)));
}

HWY_INLINE Vector3 chosen(M where, Vector3 yes, Vector3 no) {
  return {hn::IfThenElse(where, yes.x, no.x), hn::IfThenElse(where, yes.y, no.y),
          hn::IfThenElse(where, yes.z, no.z)};
}

HWY_INLINE Symmetric chosen(M where, const Symmetric& yes, const Symmetric& no) {
  return {hn::IfThenElse(where, yes.xx, no.xx), hn::IfThenElse(where, yes.xy, no.xy),
          hn::IfThenElse(where, yes.xz, no.xz), hn::IfThenElse(where, yes.yy, no.yy),
          hn::IfThenElse(where, yes.yz, no.yz), hn::IfThenElse(where, yes.zz, no.zz)};
}

// How the readings in use are weighed: as before; over the variances that the last solution predicts; what is
// brighter than predicted doubted besides.
enum class Weights { kAsTheyAre, kPredicted, kDoubted };

// Solves the active lanes anew.
template <Weights kWeights>
HWY_NOINLINE void fit_again(D d, const RowTask& task, const Scratch& scratch, M active, Estimate& e) {
  const V zero = hn::Zero(d);
  const Vector3 b = e.fit.b;
  const Variance variance(d, task, b);
  Symmetric g = zero_matrix(d);
  Vector3 rhs = zero_vector(d);
  for (std::size_t k = 0; k < task.light_count; ++k) {
    const Vector3 l = scratch.direction(k);
    const V light = scratch.light(k);
    V w = scratch.weight(k);
    if constexpr (kWeights != Weights::kAsTheyAre) {
      V v = variance.at(l, scratch.inverse_e(k));
      if constexpr (kWeights == Weights::kDoubted) {
        const V expected = hn::MulAdd(hn::Set(d, static_cast<float>(kDoubtFrom)), hn::Sqrt(v), dot(l, b));
        const V excess = hn::Max(zero, hn::Sub(light, expected));
        v = hn::MulAdd(hn::Mul(hn::Set(d, static_cast<float>(kDoubt)), excess), excess, v);
      }
      w = hn::IfThenElse(hn::And(active, hn::Gt(w, zero)), reciprocal(d, v), w);
      scratch.store_weight(k, w);
    }
    const Vector3 wl = scaled(l, w);
    add_outer(g, wl, l);
    add_scaled(rhs, light, wl);
  }
  Fit fit = solved(d, g, rhs, kWeights == Weights::kDoubted ? kDoubtedCondition : kFloatCondition);
  if constexpr (kWeights != Weights::kPredicted) {
    // Few or unequal readings: the solution once more, of its residuals, which know b to more digits than G.
    Vector3 gradient = zero_vector(d);
    for (std::size_t k = 0; k < task.light_count; ++k) {
      const Vector3 l = scratch.direction(k);
      add_scaled(gradient, hn::Mul(scratch.weight(k), hn::Sub(scratch.light(k), dot(l, fit.b))), l);
    }
    add_scaled(fit.b, hn::Set(d, 1.0f), times(fit.inverse, gradient));
  }
  e.fit.inverse = chosen(active, fit.inverse, e.fit.inverse);
  e.fit.b = chosen(active, fit.b, e.fit.b);
  e.again = hn::Or(e.again, hn::And(active, fit.poor));
  if constexpr (kWeights != Weights::kAsTheyAre) e.predictor = chosen(active, b, e.predictor);
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();

#endif
