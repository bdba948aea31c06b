// SPDX-License-Identifier: Apache-2.0
// From a solved vector of pixels to what a method returns; compiled once for every SIMD target.

#if defined(WEFT_SOLVER_KERNELS_FINISH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_SOLVER_KERNELS_FINISH_INL_H
#undef WEFT_SOLVER_KERNELS_FINISH_INL_H
#else
#define WEFT_SOLVER_KERNELS_FINISH_INL_H
#endif

#include <hwy/highway.h>

#include "core/base/vec.h"
#include "solver/kernels/gather-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft::solver {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A condition number cannot be told where the determinant is less than this share of the cube of the trace:
// minors and determinant may both be nothing but rounding, and their quotient anything.
inline constexpr float kLeastDeterminant = 1e-6f;
// Squares of albedos beyond these leave the range of float32 when they are squared again.
inline constexpr float kLeastAlbedo2 = 1e-24f, kMostAlbedo2 = 1e24f;

// A solved system.
struct Fit {
  Symmetric inverse;  // (sum w l l^T)^-1
  Vector3 b;
  M poor;  // lanes whose condition number may be over the most that is allowed
};

HWY_INLINE Fit solved(D d, const Symmetric& g, Vector3 rhs, double most_condition = kFloatCondition) {
  const Inverse inverse = inverted(d, g);
  // The eigenvalues of G sum to its trace, and determinant / minors is a lower bound of the smallest. So this
  // catches every condition number over `most_condition`.
  const V most_condition2 = hn::Set(d, static_cast<float>(most_condition * most_condition));
  const V sum = trace(g);
  const V least_determinant = hn::Mul(hn::Set(d, kLeastDeterminant), hn::Mul(sum, hn::Mul(sum, sum)));
  const M good = hn::And(hn::Gt(hn::Mul(most_condition2, inverse.determinant), hn::Mul(sum, inverse.minors)),
                         hn::Gt(inverse.determinant, least_determinant));
  return {inverse.matrix, times(inverse.matrix, rhs), hn::Not(good)};
}

HWY_INLINE M leaves_float(D d, V rho2) {
  return hn::Not(hn::And(hn::Gt(rho2, hn::Set(d, kLeastAlbedo2)), hn::Lt(rho2, hn::Set(d, kMostAlbedo2))));
}

// Which readings are in use: all; those not minus infinity; those of a weight over zero.
enum class InUse { kAll, kSelected, kWeighted };

// What a method found for a vector of pixels.
struct Found {
  Fit fit;
  const Vector3* plane_rhs;  // right-hand sides of three planes
  V count;                   // readings in use
  V scale;                   // the albedo that weighted rows are in units of
  M again;                   // lanes that must be solved again in double
  Status status;
};

// b = rho n
struct Solution {
  Vector3 b, n;
  V rho2, rho, inverse_rho;
  Vector3 plane_b[3];  // of three planes

  HWY_INLINE Solution(D d, Vector3 solved_b) : b(solved_b), rho2(dot(b, b)) {
    inverse_rho = hn::Div(hn::Set(d, 1.0f), hn::Sqrt(rho2));
    rho = hn::Mul(rho2, inverse_rho);
    n = scaled(b, inverse_rho);
  }
};

// Variances of readings over strength by the noise model.
class Noise {
 public:
  HWY_INLINE Noise(D d, const RowTask& task)
      : per_reading_(hn::Set(d, task.noise_per_reading)), floor_(hn::Set(d, task.noise_floor)) {}
  HWY_INLINE V variance(V predicted, V inverse_e) const {
    return hn::Mul(inverse_e, hn::MulAdd(per_reading_, predicted, hn::Mul(floor_, inverse_e)));
  }

 private:
  V per_reading_, floor_;
};

template <std::size_t kPlanes>
HWY_INLINE bool has_noise(const RowTask& task) {
  return kPlanes == 1 && task.has_noise;
}

// What the readings in use say of a solution.
struct Residuals {
  V square;           // sum of the squared residuals
  V plane_square[3];  // the same of each of three planes
  V weights;          // sum, of weighted rows
  V most_excess;      // of a reading over kSpecularTimes its prediction
  Symmetric noise;    // sum of w^2 v l l^T over the variances v of the noise model
  Vector3 shared;     // sum of w / e l: what noise that all readings share changes

  HWY_INLINE explicit Residuals(D d)
      : square(hn::Zero(d)),
        plane_square{square, square, square},
        weights(square),
        most_excess(hn::Neg(hn::Inf(d))),
        noise(zero_matrix(d)),
        shared(zero_vector(d)) {}
};

// Rows without weights take the same steps to the same bits whether all are in use or some.
template <std::size_t kPlanes, InUse kInUse>
HWY_INLINE Residuals residuals_of(D d, const RowTask& task, const Scratch& scratch,
                                  const Solution& solution) {
  constexpr bool kHasWeights = kInUse == InUse::kWeighted;
  const Noise noise(d, task);
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f), minus_infinity = hn::Neg(hn::Inf(d));
  const V specular_times = hn::Set(d, static_cast<float>(kSpecularTimes));
  Residuals sums(d);
  for (std::size_t k = 0; k < task.light_count; ++k) {
    const V light_sum = scratch.light(k);
    const V w = kHasWeights ? scratch.weight(k) : one;
    const M keep = kHasWeights ? hn::Gt(w, zero) : hn::Gt(light_sum, minus_infinity);
    const auto used = [&](V v) { return kInUse == InUse::kAll ? v : hn::IfThenElseZero(keep, v); };
    const auto weighted = [&](V v) { return kHasWeights ? hn::Mul(w, v) : v; };
    const Vector3 l = scratch.direction(k);
    const V fitted = dot(l, solution.b);
    const V predicted = hn::Max(fitted, zero);
    const V r = used(hn::Sub(light_sum, fitted));
    if constexpr (kHasWeights) sums.weights = hn::Add(sums.weights, w);
    sums.square = hn::MulAdd(r, r, sums.square);
    sums.most_excess = hn::Max(sums.most_excess, hn::NegMulAdd(specular_times, predicted, light_sum));
    if (has_noise<kPlanes>(task)) {
      const V inverse_e = scratch.inverse_e(k);
      const V variance = weighted(weighted(used(noise.variance(predicted, inverse_e))));
      add_outer(sums.noise, scaled(l, variance), l);
      add_scaled(sums.shared, weighted(used(inverse_e)), l);
    }
    if constexpr (kPlanes == 3) {
      for (std::size_t p = 0; p < 3; ++p) {
        const V plane_r = used(hn::Sub(scratch.plane(k, p), dot(l, solution.plane_b[p])));
        sums.plane_square[p] = hn::MulAdd(plane_r, plane_r, sums.plane_square[p]);
      }
    }
  }
  return sums;
}

// Marks lanes with a reading that no prediction, noise or margin explains.
template <std::size_t kPlanes>
HWY_INLINE void mark_specular(D d, const RowTask& task, const Scratch& scratch, const Solution& solution,
                              V most_excess, Status& status) {
  const V zero = hn::Zero(d);
  const V margin = hn::Mul(hn::Set(d, static_cast<float>(kSpecularMargin)), solution.rho);
  if (hn::AllFalse(d, hn::Gt(most_excess, margin))) return;
  const Noise noise(d, task);
  const V specular_times = hn::Set(d, static_cast<float>(kSpecularTimes)),
          sigmas2 = hn::Set(d, static_cast<float>(kSpecularSigmas * kSpecularSigmas));
  M specular = no_lane(d);
  for (std::size_t k = 0; k < task.light_count; ++k) {
    const V predicted = hn::Max(dot(scratch.direction(k), solution.b), zero);
    const V excess = hn::Sub(hn::NegMulAdd(specular_times, predicted, scratch.light(k)), margin);
    const V variance = has_noise<kPlanes>(task) ? noise.variance(predicted, scratch.inverse_e(k)) : zero;
    specular = hn::Or(
        specular, hn::And(hn::Gt(excess, zero), hn::Gt(hn::Mul(excess, excess), hn::Mul(sigmas2, variance))));
  }
  mark(status, specular, kSpecular);
}

// Variances of b: along the normal, which is that of rho, and across it, which is that of the angle times
// rho^2. Without a noise model they are in units of the variance of a reading.
struct Spread {
  V along, across;
};

// The spread by the covariance G^-1 M G^-1, where M is `residuals.noise` and what noise that all readings
// share adds.
template <std::size_t kPlanes, InUse kInUse>
HWY_INLINE Spread spread_of(D d, const RowTask& task, const Found& found, Vector3 n,
                            const Residuals& residuals) {
  const Symmetric& inverse = found.fit.inverse;
  const Vector3 u = times(inverse, n);
  if (has_noise<kPlanes>(task)) {
    const V s = hn::Set(d, task.noise_shared);
    const Vector3 shared = times(inverse, residuals.shared);
    const V along_shared = dot(u, residuals.shared);
    const V along = hn::MulAdd(s, hn::Mul(along_shared, along_shared), dot(u, times(residuals.noise, u)));
    const V all = hn::MulAdd(s, dot(shared, shared), trace_of_product(d, residuals.noise, squared(inverse)));
    return {along, hn::Sub(all, along)};
  }
  const V along = dot(n, u), across = hn::Sub(trace(inverse), along);
  if constexpr (kInUse != InUse::kWeighted) return {along, across};
  // Without a noise model all weights are alike, and the inverse is that of their sum.
  const V weight = hn::Div(residuals.weights, found.count);
  return {hn::Mul(along, weight), hn::Mul(across, weight)};
}

// Lanes whose squares left the range of float32; these leave it before anything else does.
template <std::size_t kPlanes>
HWY_INLINE M overflows(D d, const Residuals& residuals, const Spread& spread) {
  V sum = hn::Add(residuals.square, hn::Add(spread.across, spread.along));
  if constexpr (kPlanes == 3) {
    for (std::size_t p = 0; p < 3; ++p) sum = hn::Add(sum, residuals.plane_square[p]);
  }
  return hn::Not(hn::Lt(sum, hn::Inf(d)));
}

// The readings beyond the three that determine a solution.
struct Freedom {
  M any;
  V inverse;

  HWY_INLINE Freedom(D d, V count) {
    const V three = hn::Set(d, 3.0f);
    any = hn::Gt(count, three);
    inverse = hn::Div(hn::Set(d, 1.0f), hn::Sub(count, three));
  }
};

template <std::size_t kPlanes>
HWY_INLINE void store_normal(D d, const RowTask& task, std::size_t x, const Solution& solution, V count,
                             const Residuals& residuals, V across) {
  const V unknown = hn::Set(d, kUnknownAngleDeg), to_degrees = hn::Set(d, static_cast<float>(180 / kPi));
  const Freedom freedom(d, count);
  V angle2 = hn::Max(across, hn::Zero(d));
  if (!has_noise<kPlanes>(task)) angle2 = hn::Mul(angle2, hn::Mul(residuals.square, freedom.inverse));
  V sigma_deg = hn::Mul(to_degrees, hn::Mul(hn::Sqrt(angle2), solution.inverse_rho));
  if (!has_noise<kPlanes>(task)) sigma_deg = hn::IfThenElse(freedom.any, sigma_deg, unknown);
  hn::StoreU(hn::Min(sigma_deg, unknown), d, task.sigma_normal_deg + x);
  hn::StoreU(hn::Mul(hn::Sqrt(hn::Div(residuals.square, count)), solution.inverse_rho), d, task.residual + x);
  hn::StoreU(solution.n.x, d, task.normal[0] + x);
  hn::StoreU(solution.n.y, d, task.normal[1] + x);
  hn::StoreU(solution.n.z, d, task.normal[2] + x);
}

template <std::size_t kPlanes, InUse kInUse>
HWY_INLINE void store_albedo(D d, const RowTask& task, std::size_t x, const Solution& solution,
                             const Found& found, const Residuals& residuals, V along) {
  const Freedom freedom(d, found.count);
  const auto absolute = [&](V v) {
    return kInUse == InUse::kWeighted && kPlanes == 1 ? hn::Mul(found.scale, v) : v;
  };
  for (std::size_t p = 0; p < kPlanes; ++p) {
    const V albedo = kPlanes == 1 ? solution.rho : hn::Max(hn::Zero(d), dot(solution.n, solution.plane_b[p]));
    V sigma = hn::Sqrt(hn::Max(along, hn::Zero(d)));
    if (!has_noise<kPlanes>(task)) {
      const V square = kPlanes == 1 ? residuals.square : residuals.plane_square[p];
      const V of_scatter = hn::Mul(sigma, hn::Sqrt(hn::Mul(square, freedom.inverse)));
      sigma = hn::IfThenElse(freedom.any, of_scatter, albedo);
    }
    hn::StoreU(absolute(albedo), d, task.albedo[p] + x);
    hn::StoreU(absolute(sigma), d, task.sigma_albedo[p] + x);
  }
}

// Writes everything a method returns to column `x`. Returns whether some lane asks to be solved again.
template <std::size_t kPlanes, InUse kInUse>
HWY_INLINE bool finish(D d, const RowTask& task, const Scratch& scratch, std::size_t x, const Found& found) {
  Solution solution(d, found.fit.b);
  if constexpr (kPlanes == 3) {
    for (std::size_t p = 0; p < 3; ++p) solution.plane_b[p] = times(found.fit.inverse, found.plane_rhs[p]);
  }
  const Residuals residuals = residuals_of<kPlanes, kInUse>(d, task, scratch, solution);
  Status status = found.status;
  mark_specular<kPlanes>(d, task, scratch, solution, residuals.most_excess, status);
  const Spread spread = spread_of<kPlanes, kInUse>(d, task, found, solution.n, residuals);
  const M unfit = hn::Or(found.fit.poor, leaves_float(d, solution.rho2));
  const M again = hn::Or(found.again, hn::Or(unfit, overflows<kPlanes>(d, residuals, spread)));
  mark(status, again, kSolveAgain);
  mark(status, hn::Eq(found.count, hn::Set(d, 3.0f)), kZeroDof);
  store_normal<kPlanes>(d, task, x, solution, found.count, residuals, spread.across);
  store_albedo<kPlanes, kInUse>(d, task, x, solution, found, residuals, spread.along);
  const hn::Rebind<std::uint16_t, D> d16;
  hn::StoreU(hn::DemoteTo(d16, status), d16, task.status + x);
  return !hn::AllFalse(d, again);
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();

#endif
