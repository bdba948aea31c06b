// SPDX-License-Identifier: Apache-2.0
// Vectors and symmetric matrices of three dimensions, a pixel a lane; compiled once for every SIMD target.

#if defined(WEFT_SOLVER_KERNELS_VECTOR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_SOLVER_KERNELS_VECTOR_INL_H
#undef WEFT_SOLVER_KERNELS_VECTOR_INL_H
#else
#define WEFT_SOLVER_KERNELS_VECTOR_INL_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace weft::solver {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

// 1 / sqrt(v) to about 1e-7: the estimate of the machine and one step of Newton's method.
HWY_INLINE V reciprocal_sqrt(D d, V v) {
#if HWY_TARGET == HWY_SCALAR
  return hn::Div(hn::Set(d, 1.0f), hn::Sqrt(v));
#else
  const V y = hn::ApproximateReciprocalSqrt(v);
  const V half_v = hn::Mul(hn::Set(d, 0.5f), v);
  return hn::Mul(y, hn::NegMulAdd(half_v, hn::Mul(y, y), hn::Set(d, 1.5f)));
#endif
}

// 1 / v to about 1e-7; the same construction.
HWY_INLINE V reciprocal(D d, V v) {
#if HWY_TARGET == HWY_SCALAR
  return hn::Div(hn::Set(d, 1.0f), v);
#else
  const V y = hn::ApproximateReciprocal(v);
  return hn::Mul(y, hn::NegMulAdd(v, y, hn::Set(d, 2.0f)));
#endif
}

HWY_INLINE M no_lane(D d) {
  return hn::Lt(hn::Set(d, 1.0f), hn::Zero(d));
}

struct Vector3 {
  V x, y, z;
};

HWY_INLINE Vector3 zero_vector(D d) {
  const V z = hn::Zero(d);
  return {z, z, z};
}

HWY_INLINE Vector3 scaled(Vector3 a, V w) {
  return {hn::Mul(a.x, w), hn::Mul(a.y, w), hn::Mul(a.z, w)};
}

// Zero in the other lanes.
HWY_INLINE Vector3 masked(M where, Vector3 a) {
  return {hn::IfThenElseZero(where, a.x), hn::IfThenElseZero(where, a.y), hn::IfThenElseZero(where, a.z)};
}

HWY_INLINE V dot(Vector3 a, Vector3 b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

// A symmetric 3 x 3 matrix.
struct Symmetric {
  V xx, xy, xz, yy, yz, zz;
};

HWY_INLINE Symmetric zero_matrix(D d) {
  const V z = hn::Zero(d);
  return {z, z, z, z, z, z};
}

// m += (w a) a^T, with wa = w a.
HWY_INLINE void add_outer(Symmetric& m, Vector3 wa, Vector3 a) {
  m.xx = hn::MulAdd(wa.x, a.x, m.xx);
  m.xy = hn::MulAdd(wa.x, a.y, m.xy);
  m.xz = hn::MulAdd(wa.x, a.z, m.xz);
  m.yy = hn::MulAdd(wa.y, a.y, m.yy);
  m.yz = hn::MulAdd(wa.y, a.z, m.yz);
  m.zz = hn::MulAdd(wa.z, a.z, m.zz);
}

HWY_INLINE void add_scaled(Vector3& sum, V w, Vector3 a) {
  sum.x = hn::MulAdd(w, a.x, sum.x);
  sum.y = hn::MulAdd(w, a.y, sum.y);
  sum.z = hn::MulAdd(w, a.z, sum.z);
}

HWY_INLINE Vector3 times(const Symmetric& m, Vector3 v) {
  return {dot({m.xx, m.xy, m.xz}, v), dot({m.xy, m.yy, m.yz}, v), dot({m.xz, m.yz, m.zz}, v)};
}

HWY_INLINE V trace(const Symmetric& m) {
  return hn::Add(m.xx, hn::Add(m.yy, m.zz));
}

// Sum of the products of all nine elements: tr(A B).
HWY_INLINE V trace_of_product(D d, const Symmetric& a, const Symmetric& b) {
  const V off = hn::MulAdd(a.xy, b.xy, hn::MulAdd(a.xz, b.xz, hn::Mul(a.yz, b.yz)));
  return hn::MulAdd(hn::Set(d, 2.0f), off,
                    hn::MulAdd(a.xx, b.xx, hn::MulAdd(a.yy, b.yy, hn::Mul(a.zz, b.zz))));
}

HWY_INLINE Symmetric squared(const Symmetric& m) {
  const Vector3 x = {m.xx, m.xy, m.xz}, y = {m.xy, m.yy, m.yz}, z = {m.xz, m.yz, m.zz};
  return {dot(x, x), dot(x, y), dot(x, z), dot(y, y), dot(y, z), dot(z, z)};
}

struct Inverse {
  Symmetric matrix;
  V determinant;
  V minors;  // sum of the principal 2 x 2 minors
};

HWY_INLINE Inverse inverted(D d, const Symmetric& g) {
  const auto minor = [](V a, V b, V c, V e) { return hn::NegMulAdd(c, e, hn::Mul(a, b)); };  // a b - c e
  Symmetric adjugate;
  adjugate.xx = minor(g.yy, g.zz, g.yz, g.yz);
  adjugate.xy = minor(g.xz, g.yz, g.xy, g.zz);
  adjugate.xz = minor(g.xy, g.yz, g.xz, g.yy);
  adjugate.yy = minor(g.xx, g.zz, g.xz, g.xz);
  adjugate.yz = minor(g.xy, g.xz, g.xx, g.yz);
  adjugate.zz = minor(g.xx, g.yy, g.xy, g.xy);
  Inverse result;
  result.determinant = dot({g.xx, g.xy, g.xz}, {adjugate.xx, adjugate.xy, adjugate.xz});
  result.minors = trace(adjugate);
  const V s = hn::Div(hn::Set(d, 1.0f), result.determinant);
  result.matrix = {hn::Mul(adjugate.xx, s), hn::Mul(adjugate.xy, s), hn::Mul(adjugate.xz, s),
                   hn::Mul(adjugate.yy, s), hn::Mul(adjugate.yz, s), hn::Mul(adjugate.zz, s)};
  return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();

#endif
