// SPDX-License-Identifier: Apache-2.0
// The row kernels of weighted.cpp, compiled once for every SIMD target.

#include <hwy/highway.h>

#include "solver/kernels/estimate-inl.h"
#include "solver/kernels/finish-inl.h"
#include "solver/kernels/gather-inl.h"
#include "solver/kernels/trimmed-inl.h"
#include "solver/kernels/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft::solver {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Shadowed readings that the others predict to be lit, and as bright as they are.
HWY_NOINLINE M take_back_what_fits(D d, const RowTask& task, const Scratch& scratch, Estimate& e) {
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f), minus_infinity = hn::Neg(hn::Inf(d));
  const V least_lit = hn::Set(d, static_cast<float>(kTakenBackFrom * kTakenBackFrom)),
          reject_from = hn::Set(d, static_cast<float>(kRejectFrom));
  const Variance variance(d, task, e.predictor);
  M any = no_lane(d), left_out = any;
  for (std::size_t k = 0; k < task.light_count; ++k) {
    const V light = scratch.shadowed(k);
    const M shadowed = hn::Gt(light, minus_infinity);
    if (hn::AllFalse(d, shadowed)) continue;
    const Vector3 l = scratch.direction(k);
    const V predicted = dot(l, e.fit.b), misfit = hn::Sub(light, predicted);
    const V sigma2 = hn::Add(variance.at(l, scratch.inverse_e(k)), quadratic(d, e.fit.inverse, l));
    const M lit =
        hn::And(hn::Gt(predicted, zero), hn::Gt(hn::Mul(predicted, predicted), hn::Mul(least_lit, sigma2)));
    const M fits =
        hn::And(shadowed, hn::And(lit, hn::Le(hn::Mul(misfit, misfit), hn::Mul(reject_from, sigma2))));
    any = hn::Or(any, fits);
    left_out = hn::Or(left_out, hn::AndNot(fits, shadowed));
    scratch.store_light(k, hn::IfThenElse(fits, light, scratch.light(k)));
    scratch.store_weight(k, hn::IfThenElse(fits, one, scratch.weight(k)));
    e.count = hn::Add(e.count, hn::IfThenElseZero(fits, one));
  }
  if (!hn::AllFalse(d, any)) fit_again<Weights::kPredicted>(d, task, scratch, any, e);
  return left_out;
}

struct Misfit {
  V t2;       // times `freedom`: the square over its variance
  V freedom;  // what is left of it once the reading's own pull is taken out
  M suspect;  // may have to go
};

HWY_INLINE Misfit misfit_of(D d, const Scratch& scratch, std::size_t k, const Estimate& e) {
  const Vector3 l = scratch.direction(k);
  const V w = scratch.weight(k), r = hn::Sub(scratch.light(k), dot(l, e.fit.b));
  const V t2 = hn::Mul(hn::Mul(r, r), w);
  const V freedom = hn::NegMulAdd(w, quadratic(d, e.fit.inverse, l), hn::Set(d, 1.0f));
  const V reject_from = hn::Set(d, static_cast<float>(kRejectFrom));
  return {t2, freedom,
          hn::And(hn::Gt(t2, hn::Mul(reject_from, freedom)),
                  hn::Gt(freedom, hn::Set(d, static_cast<float>(kLeastFreedom))))};
}

// Leaves out of each lane the reading that the others contradict most. Returns the lanes that had one.
HWY_NOINLINE M drop_worst_misfit(D d, const RowTask& task, const Scratch& scratch, M active, Estimate& e) {
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  V scatter = zero, most = zero, worst = hn::Neg(one);
  for (std::size_t k = 0; k < task.light_count; ++k) {
    const Misfit misfit = misfit_of(d, scratch, k, e);
    scatter = hn::Add(scatter, misfit.t2);
    const V t2 = hn::IfThenElseZero(misfit.suspect, hn::Div(misfit.t2, misfit.freedom));
    worst = hn::IfThenElse(hn::Gt(t2, most), hn::Set(d, static_cast<float>(k)), worst);
    most = hn::Max(most, t2);
  }
  const V others = hn::Div(hn::Sub(scatter, most), hn::Sub(e.count, hn::Set(d, 4.0f)));
  const V limit = hn::Mul(hn::Set(d, static_cast<float>(kRejectFrom)), hn::Max(one, others));
  const M dropped = hn::And(active, hn::Gt(most, limit));
  if (hn::AllFalse(d, dropped)) return dropped;
  for (std::size_t k = 0; k < task.light_count; ++k) {
    const M gone = hn::And(dropped, hn::Eq(worst, hn::Set(d, static_cast<float>(k))));
    scratch.store_weight(k, hn::IfThenZeroElse(gone, scratch.weight(k)));
  }
  e.count = hn::Sub(e.count, hn::IfThenElseZero(dropped, one));
  e.rejected = hn::Add(e.rejected, hn::IfThenElseZero(dropped, one));
  return dropped;
}

// Rejects what the others contradict, one by one.
HWY_INLINE void reject_misfits(D d, const RowTask& task, const Scratch& scratch, M active, Estimate& e) {
  for (int i = 0; i < kMostRejected; ++i) {
    active = hn::And(active, hn::Gt(e.count, hn::Set(d, static_cast<float>(kLeastKept))));
    M suspect = no_lane(d);
    for (std::size_t k = 0; k < task.light_count; ++k)
      suspect = hn::Or(suspect, misfit_of(d, scratch, k, e).suspect);
    active = hn::And(active, suspect);
    if (hn::AllFalse(d, active)) return;
    active = drop_worst_misfit(d, task, scratch, active, e);
    if (hn::AllFalse(d, active)) return;
    fit_again<Weights::kAsTheyAre>(d, task, scratch, active, e);
  }
}

// Readings and strengths in units of the first solution's albedo, so that no weight leaves the range of
// float32, and that solution. What is not in use becomes zero, without weight.
HWY_INLINE Estimate first_estimate(D d, const RowTask& task, const Scratch& scratch, bool selected,
                                   const Fit& fit, V count, M again, V& scale) {
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f), minus_infinity = hn::Neg(hn::Inf(d));
  const V rho2 = dot(fit.b, fit.b);
  again = hn::Or(again, hn::Or(fit.poor, leaves_float(d, rho2)));
  scale = hn::Sqrt(rho2);
  const V per_scale = hn::Div(one, scale);
  for (std::size_t k = 0; k < task.light_count; ++k) {
    const V light = scratch.light(k);
    const M keep = hn::Gt(light, minus_infinity);
    M readable = keep;
    if (selected) {
      const V shadowed = scratch.shadowed(k);
      readable = hn::Or(readable, hn::Gt(shadowed, minus_infinity));
      scratch.store_shadowed(k, hn::Mul(shadowed, per_scale));
    }
    scratch.store_light(k, hn::IfThenElseZero(keep, hn::Mul(light, per_scale)));
    scratch.store_inverse_e(k, hn::IfThenElseZero(readable, hn::Mul(scratch.inverse_e(k), per_scale)));
    scratch.store_weight(k, hn::IfThenElseZero(keep, one));
  }
  const Vector3 b = scaled(fit.b, per_scale);
  return {{fit.inverse, b, fit.poor}, b, count, zero, again};
}

// Right-hand sides of the planes under the last weights.
HWY_INLINE void weigh_planes(D d, const RowTask& task, const Scratch& scratch, Vector3* plane_rhs) {
  for (std::size_t p = 0; p < 3; ++p) plane_rhs[p] = zero_vector(d);
  for (std::size_t k = 0; k < task.light_count; ++k) {
    const V w = scratch.weight(k);
    const M keep = hn::Gt(w, hn::Zero(d));
    const Vector3 l = scratch.direction(k);
    for (std::size_t p = 0; p < 3; ++p)
      add_scaled(plane_rhs[p], hn::IfThenElseZero(keep, hn::Mul(w, scratch.plane(k, p))), l);
  }
}

// Readings rejected in the lanes that this kernel answers for and that belong to the image.
HWY_NOINLINE std::int64_t count_rejected(D d, const RowTask& task, std::size_t x, const Estimate& e) {
  const M counted = hn::AndNot(e.again, hn::FirstN(d, task.width - x));
  return static_cast<std::int64_t>(hn::GetLane(hn::SumOfLanes(d, hn::IfThenElseZero(counted, e.rejected))));
}

// One vector of pixels. Returns whether some lane asks to be solved again.
template <std::size_t kPlanes>
HWY_INLINE bool solve_weighted_columns(D d, RowTask& task, const Scratch& scratch, std::size_t x) {
  const Columns columns(d, task, x);
  const M none = no_lane(d), all = hn::Not(none);
  Sums<kPlanes> sums(d);
  Status status = hn::Zero(hn::RebindToSigned<D>());
  Selection selection = {none, none};
  const bool all_count = gather(d, task, scratch, columns, sums) && task.light_count > 3;
  if (!all_count) selection = select(d, task, scratch, columns, sums, status);

  V scale;
  Estimate e = first_estimate(d, task, scratch, !all_count, solved(d, sums.g, sums.rhs), sums.count,
                              selection.again, scale);
  fit_again<Weights::kPredicted>(d, task, scratch, all, e);
  M shadowed = selection.shadowed, trimmed = none;
  if (task.estimator == Estimator::kTrimmed) trimmed = start_from_most_consistent(d, task, scratch, e);
  if (!hn::AllFalse(d, shadowed)) shadowed = take_back_what_fits(d, task, scratch, e);
  if (task.estimator != Estimator::kWeighted) {
    const M judged = hn::Not(trimmed);
    if (!hn::AllFalse(d, judged)) {
      reject_misfits(d, task, scratch, judged, e);
      fit_again<Weights::kPredicted>(d, task, scratch, judged, e);
    }
    if (!hn::AllFalse(d, trimmed)) doubt_highlights(d, task, scratch, trimmed, e);
    if (!hn::AllFalse(d, hn::Gt(e.rejected, hn::Zero(d)))) task.rejected += count_rejected(d, task, x, e);
  }
  mark(status, shadowed, kShadowed);
  if constexpr (kPlanes == 3) weigh_planes(d, task, scratch, sums.plane_rhs);
  return finish<kPlanes, InUse::kWeighted>(d, task, scratch, x,
                                           {e.fit, sums.plane_rhs, e.count, scale, e.again, status});
}

template <std::size_t kPlanes>
bool solve_weighted_row(RowTask& task) {
  const D d;
  const Scratch scratch(d, task.scratch, task.light_count);
  bool again = false;
  for (std::size_t x = 0; x < task.width; x += hn::Lanes(d))
    again |= solve_weighted_columns<kPlanes>(d, task, scratch, x);
  return again;
}

bool solve_weighted_mosaic_row(RowTask& task) {
  return solve_weighted_row<1>(task);
}
bool solve_weighted_rgb_row(RowTask& task) {
  return solve_weighted_row<3>(task);
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();
