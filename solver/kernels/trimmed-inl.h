// SPDX-License-Identifier: Apache-2.0
// Least trimmed squares of a vector of pixels; compiled once for every SIMD target.

#if defined(WEFT_SOLVER_KERNELS_TRIMMED_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_SOLVER_KERNELS_TRIMMED_INL_H
#undef WEFT_SOLVER_KERNELS_TRIMMED_INL_H
#else
#define WEFT_SOLVER_KERNELS_TRIMMED_INL_H
#endif

#include <hwy/highway.h>

#include "solver/in_double/triples.h"
#include "solver/kernels/estimate-inl.h"
#include "solver/kernels/gather-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft::solver {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The kListed largest of the values added, in falling order; the others are summed.
template <std::size_t kListed>
class Largest {
 public:
  HWY_INLINE explicit Largest(D d) : sum_(hn::Zero(d)) {
    for (V& v : largest_) v = sum_;
  }
  // Values are not negative.
  HWY_INLINE void add(V v) {
    for (V& kept : largest_) {
      const V larger = hn::Max(kept, v);
      v = hn::Min(kept, v);
      kept = larger;
    }
    sum_ = hn::Add(sum_, v);
  }
  // Sum of all but the `left_out` largest.
  HWY_INLINE V sum_of_others(D d, V left_out) const {
    V sum = sum_;
    for (std::size_t i = 0; i < kListed; ++i)
      sum =
          hn::Add(sum, hn::IfThenElseZero(hn::Le(left_out, hn::Set(d, static_cast<float>(i))), largest_[i]));
    return sum;
  }
  // The largest of those that are summed.
  HWY_INLINE V next(D d, V left_out) const {
    V value = largest_[0];
    for (std::size_t i = 1; i < kListed; ++i)
      value = hn::IfThenElse(hn::Eq(left_out, hn::Set(d, static_cast<float>(i))), largest_[i], value);
    return value;
  }

 private:
  V largest_[kListed];
  V sum_;
};

// The square of a reading's misfit over its variance; zero where it is not in use.
HWY_INLINE V squared_misfit(const Scratch& scratch, std::size_t k, Vector3 b) {
  const V r = hn::Sub(scratch.light(k), dot(scratch.direction(k), b));
  return hn::Mul(hn::Mul(r, r), scratch.weight(k));
}

// A start of each lane.
struct Start {
  Vector3 b;
  V scatter;  // of the readings that agree with it
  M found;
};

HWY_INLINE Vector3 cross(Vector3 a, Vector3 b) {
  const auto minor = [](V p, V q, V r, V s) { return hn::NegMulAdd(r, s, hn::Mul(p, q)); };  // p q - r s
  return {minor(a.y, b.z, a.z, b.y), minor(a.z, b.x, a.x, b.z), minor(a.x, b.y, a.y, b.x)};
}

// Tries all triples of lights in lexical order, the first of equals first.
template <std::size_t kMostLeftOut>
HWY_INLINE Start best_triple(D d, const RowTask& task, const Scratch& scratch, M active, V left_out,
                             Start best) {
  const V zero = hn::Zero(d), least_determinant = hn::Set(d, static_cast<float>(kLeastTripleDeterminant));
  const std::size_t n = task.light_count;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const Vector3 li = scratch.direction(i), lj = scratch.direction(j);
      const V xi = scratch.light(i), xj = scratch.light(j);
      const M both = hn::And(active, hn::Gt(hn::Min(scratch.weight(i), scratch.weight(j)), zero));
      if (hn::AllFalse(d, both)) continue;
      const Vector3 c = cross(li, lj);
      const Vector3 m = {hn::NegMulAdd(xj, li.x, hn::Mul(xi, lj.x)),
                         hn::NegMulAdd(xj, li.y, hn::Mul(xi, lj.y)),
                         hn::NegMulAdd(xj, li.z, hn::Mul(xi, lj.z))};
      for (std::size_t k = j + 1; k < n; ++k) {
        // b |l_i l_j l_k| = x_k l_i x l_j + (x_i l_j - x_j l_i) x l_k
        const Vector3 lk = scratch.direction(k);
        const V determinant = dot(c, lk), xk = scratch.light(k);
        const M usable = hn::And(hn::And(both, hn::Gt(scratch.weight(k), zero)),
                                 hn::Gt(hn::Abs(determinant), least_determinant));
        if (hn::AllFalse(d, usable)) continue;
        const V inverse = reciprocal(d, determinant);
        Vector3 b = cross(m, lk);
        add_scaled(b, xk, c);
        b = scaled(b, inverse);
        Largest<kMostLeftOut> misfits(d);
        for (std::size_t q = 0; q < n; ++q) misfits.add(squared_misfit(scratch, q, b));
        const V scatter = misfits.sum_of_others(d, left_out);
        const M better = hn::And(usable, hn::Lt(scatter, best.scatter));
        best.b = chosen(better, b, best.b);
        best.scatter = hn::IfThenElse(better, scatter, best.scatter);
        best.found = hn::Or(best.found, better);
      }
    }
  }
  return best;
}

// n - trimmed_count(n) of the readings in use.
HWY_INLINE V trimmed_off(D d, const RowTask& task, V count) {
  V left_out = hn::Zero(d);
  for (std::size_t n = kLeastKept; n <= task.light_count; ++n) {
    const V of_n = hn::Set(d, static_cast<float>(n - trimmed_count(n)));
    left_out = hn::IfThenElse(hn::Eq(count, hn::Set(d, static_cast<float>(n))), of_n, left_out);
  }
  return left_out;
}

// Leaves out what the start does not agree with, by the scale that the covered readings show.
template <std::size_t kMostLeftOut>
HWY_INLINE void keep_what_agrees(D d, const RowTask& task, const Scratch& scratch, V left_out,
                                 const Start& start, Estimate& e) {
  const V one = hn::Set(d, 1.0f);
  Largest<kMostLeftOut + 1> misfits(d);
  for (std::size_t k = 0; k < task.light_count; ++k) misfits.add(squared_misfit(scratch, k, start.b));
  const V covered = hn::Sub(e.count, left_out);
  const V scale2 = hn::Max(one, hn::Div(start.scatter, hn::Sub(covered, hn::Set(d, 2.0f))));
  const V limit =
      hn::Max(hn::Mul(hn::Set(d, static_cast<float>(kRejectFrom)), scale2), misfits.next(d, left_out));
  for (std::size_t k = 0; k < task.light_count; ++k) {
    const M gone = hn::And(start.found, hn::Gt(squared_misfit(scratch, k, start.b), limit));
    scratch.store_weight(k, hn::IfThenZeroElse(gone, scratch.weight(k)));
    e.count = hn::Sub(e.count, hn::IfThenElseZero(gone, one));
    e.rejected = hn::Add(e.rejected, hn::IfThenElseZero(gone, one));
  }
}

template <std::size_t kMostLeftOut>
HWY_NOINLINE void trim(D d, const RowTask& task, const Scratch& scratch, M active, V scatter, Estimate& e) {
  const V left_out = trimmed_off(d, task, e.count);
  Start start = {e.fit.b, hn::Mul(hn::Set(d, static_cast<float>(kTrimmedShare)), scatter), no_lane(d)};
  start = best_triple<kMostLeftOut>(d, task, scratch, active, left_out, start);
  if (hn::AllFalse(d, start.found)) return;
  keep_what_agrees<kMostLeftOut>(d, task, scratch, left_out, start, e);
  fit_again<Weights::kAsTheyAre>(d, task, scratch, start.found, e);
  fit_again<Weights::kPredicted>(d, task, scratch, start.found, e);
}

// Where the readings scatter, starts over from the triple of lights that most of them agree with, if that
// explains them far better. Returns the lanes that asked.
HWY_INLINE M start_from_most_consistent(D d, const RowTask& task, const Scratch& scratch, Estimate& e) {
  V scatter = hn::Zero(d);
  for (std::size_t k = 0; k < task.light_count; ++k)
    scatter = hn::Add(scatter, squared_misfit(scratch, k, e.fit.b));
  const V freedom = hn::Sub(e.count, hn::Set(d, 3.0f));
  const M asks = hn::And(hn::Gt(e.count, hn::Set(d, static_cast<float>(kLeastKept))),
                         hn::Gt(scatter, hn::Mul(hn::Set(d, task.trim_from), freedom)));
  if (hn::AllFalse(d, asks)) return asks;
  if (task.light_count > kMostTrimmedLights) {
    e.again = hn::Or(e.again, asks);
  } else if (task.light_count == kMostTrimmedLights) {
    trim<3>(d, task, scratch, asks, scatter, e);
  } else {
    trim<2>(d, task, scratch, asks, scatter, e);
  }
  return asks;
}

// A highlight adds light, nothing takes any away: what is brighter than predicted is doubted the more the
// brighter it is.
HWY_INLINE void doubt_highlights(D d, const RowTask& task, const Scratch& scratch, M active, Estimate& e) {
  for (int i = 0; i < kDoubtRounds; ++i) fit_again<Weights::kDoubted>(d, task, scratch, active, e);
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();

#endif
