// SPDX-License-Identifier: Apache-2.0
// From a solved vector of pixels to what a method returns; compiled once for every SIMD target.

#if defined(WEFT_SOLVER_KERNELS_FINISH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_SOLVER_KERNELS_FINISH_INL_H
#undef WEFT_SOLVER_KERNELS_FINISH_INL_H
#else
#define WEFT_SOLVER_KERNELS_FINISH_INL_H
#endif

#include <hwy/highway.h>

#include "core/vec.h"
#include "solver/kernels/gather-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft::solver {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A solved system.
struct Fit {
  Symmetric inverse;  // (sum w l l^T)^-1
  Vector3 b;
  M poor;  // lanes whose condition number may be over the most that is allowed
};

HWY_INLINE Fit solved(D d, const Symmetric& g, Vector3 rhs, double most_condition = kFloatCondition) {
  const Inverse inverse = inverted(d, g);
  // The eigenvalues of G sum to its trace and determinant / minors is a lower bound of the smallest, so this
  // catches every condition number over `most_condition`. Below the least determinant that goes with such a
  // condition number, minors and determinant may both be nothing but rounding, and their quotient anything.
  const V most_condition2 = hn::Set(d, static_cast<float>(most_condition * most_condition));
  const V sum = trace(g);
  const V least_determinant = hn::Mul(hn::Set(d, 1e-6f), hn::Mul(sum, hn::Mul(sum, sum)));
  const M good = hn::And(hn::Gt(hn::Mul(most_condition2, inverse.determinant), hn::Mul(sum, inverse.minors)),
                         hn::Gt(inverse.determinant, least_determinant));
  return {inverse.matrix, times(inverse.matrix, rhs), hn::Not(good)};
}

// Which readings are in use: all; those not minus infinity; those of a weight over zero.
enum class InUse { kAll, kSelected, kWeighted };

// Residuals, covariance and status of a solution, written to column `x`. Rows without weights take the same
// steps to the same bits whether all are in use or some. Weighted rows are in units of `scale`. Returns
// whether some lane asks to be solved again.
template <std::size_t kPlanes, InUse kInUse>
HWY_INLINE bool finish(D d, const RowTask& task, const Scratch& scratch, std::size_t x, const Fit& fit,
                       const Vector3* plane_rhs, V count, V scale, M again, Status status) {
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f), three = hn::Set(d, 3.0f);
  const V minus_infinity = hn::Neg(hn::Inf(d));
  const Vector3 b = fit.b;
  const V rho2 = dot(b, b);
  const V inverse_rho = hn::Div(one, hn::Sqrt(rho2));
  const V rho = hn::Mul(rho2, inverse_rho);
  const Vector3 n = {hn::Mul(b.x, inverse_rho), hn::Mul(b.y, inverse_rho), hn::Mul(b.z, inverse_rho)};
  Vector3 plane_b[3];
  if constexpr (kPlanes == 3) {
    for (std::size_t p = 0; p < 3; ++p) plane_b[p] = times(fit.inverse, plane_rhs[p]);
  }

  again = hn::Or(again, fit.poor);
  again = hn::Or(again, hn::Not(hn::And(hn::Gt(rho2, hn::Set(d, 1e-24f)), hn::Lt(rho2, hn::Set(d, 1e24f)))));

  // Residuals and the covariance C = G^-1 M G^-1 of b.
  const bool modelled = kPlanes == 1 && task.has_noise;
  const V per_reading = hn::Set(d, task.noise_per_reading), floor = hn::Set(d, task.noise_floor);
  const V specular_times = hn::Set(d, static_cast<float>(kSpecularTimes));
  V residual2 = zero, weights = zero, most_excess = minus_infinity;
  V plane_residual2[3] = {zero, zero, zero};
  Symmetric m = zero_matrix(d);
  Vector3 shared = {zero, zero, zero};
  const auto variance_of = [&](V predicted, V inverse_e) {
    return hn::Mul(inverse_e, hn::MulAdd(per_reading, predicted, hn::Mul(floor, inverse_e)));
  };
  for (std::size_t k = 0; k < task.light_count; ++k) {
    const V light_sum = scratch.light(k);
    const V w = kInUse == InUse::kWeighted ? scratch.weight(k) : one;
    const M keep = kInUse == InUse::kWeighted ? hn::Gt(w, zero) : hn::Gt(light_sum, minus_infinity);
    const auto kept = [&](V v) { return kInUse == InUse::kAll ? v : hn::IfThenElseZero(keep, v); };
    const auto weighted = [&](V v) { return kInUse == InUse::kWeighted ? hn::Mul(w, v) : v; };
    const Vector3 l = scratch.direction(k);
    const V fitted = dot(l, b);
    const V predicted = hn::Max(fitted, zero);
    const V r = kept(hn::Sub(light_sum, fitted));
    if constexpr (kInUse == InUse::kWeighted) weights = hn::Add(weights, w);
    residual2 = hn::MulAdd(r, r, residual2);
    most_excess = hn::Max(most_excess, hn::NegMulAdd(specular_times, predicted, light_sum));
    if (modelled) {
      const V inverse_e = scratch.inverse_e(k);
      const V variance = weighted(weighted(kept(variance_of(predicted, inverse_e))));
      add_outer(m, {hn::Mul(variance, l.x), hn::Mul(variance, l.y), hn::Mul(variance, l.z)}, l);
      add_scaled(shared, weighted(kept(inverse_e)), l);
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
  const Vector3 u = times(fit.inverse, n);
  V angle2, along_n;
  if (modelled) {
    const V s = hn::Set(d, task.noise_shared);
    const Vector3 inverse_shared = times(fit.inverse, shared);
    const V un = dot(u, shared);
    along_n = hn::MulAdd(s, hn::Mul(un, un), dot(u, times(m, u)));
    angle2 = hn::MulAdd(s, dot(inverse_shared, inverse_shared), trace_of_product(d, m, squared(fit.inverse)));
    angle2 = hn::Sub(angle2, along_n);
  } else {
    along_n = dot(n, u);
    angle2 = hn::Sub(trace(fit.inverse), along_n);
    if constexpr (kInUse == InUse::kWeighted) {
      // Without a noise model all weights are alike, and the inverse is that of their sum.
      const V weight = hn::Div(weights, count);
      along_n = hn::Mul(along_n, weight);
      angle2 = hn::Mul(angle2, weight);
    }
  }
  V scatter = hn::Add(residual2, hn::Add(angle2, along_n));
  if constexpr (kPlanes == 3) {
    for (std::size_t p = 0; p < 3; ++p) scatter = hn::Add(scatter, plane_residual2[p]);
  }
  again = hn::Or(again, hn::Not(hn::Lt(scatter, hn::Inf(d))));  // squares leave the range of float32 first
  mark(status, again, kSolveAgain);
  mark(status, hn::Eq(count, three), kZeroDof);
  angle2 = hn::Max(angle2, zero);
  along_n = hn::Max(along_n, zero);
  const V inverse_freedom = hn::Div(one, hn::Sub(count, three));
  const M determined = hn::Gt(count, three);
  if (!modelled) angle2 = hn::Mul(angle2, hn::Mul(residual2, inverse_freedom));
  V sigma_deg = hn::Mul(to_degrees, hn::Mul(hn::Sqrt(angle2), inverse_rho));
  const V unknown = hn::Set(d, kUnknownAngleDeg);
  if (!modelled) sigma_deg = hn::IfThenElse(determined, sigma_deg, unknown);
  hn::StoreU(hn::Min(sigma_deg, unknown), d, task.sigma_normal_deg + x);
  hn::StoreU(hn::Mul(hn::Sqrt(hn::Div(residual2, count)), inverse_rho), d, task.residual + x);
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
    const auto absolute = [&](V v) {
      return kInUse == InUse::kWeighted && kPlanes == 1 ? hn::Mul(scale, v) : v;
    };
    hn::StoreU(absolute(albedo), d, task.albedo[p] + x);
    hn::StoreU(absolute(sigma), d, task.sigma_albedo[p] + x);
  }
  const hn::Rebind<std::uint16_t, D> d16;
  hn::StoreU(hn::DemoteTo(d16, status), d16, task.status + x);
  return !hn::AllFalse(d, again);
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();

#endif
