// SPDX-License-Identifier: Apache-2.0
// Lobes of a vector of pixels, as solver/reflectance/lobe.h has them; compiled once for every SIMD target.

#if defined(WEFT_SOLVER_REFLECTANCE_LOBE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_SOLVER_REFLECTANCE_LOBE_INL_H
#undef WEFT_SOLVER_REFLECTANCE_LOBE_INL_H
#else
#define WEFT_SOLVER_REFLECTANCE_LOBE_INL_H
#endif

#include <hwy/highway.h>
// math-inl.h comes after highway.h.
#include <hwy/contrib/math/math-inl.h>

#include "solver/kernels/vector-inl.h"
#include "solver/reflectance/lobe.h"

HWY_BEFORE_NAMESPACE();
namespace weft::solver {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE V number(D d, double v) {
  return hn::Set(d, static_cast<float>(v));
}
HWY_INLINE V square_of(V v) {
  return hn::Mul(v, v);
}
HWY_INLINE Vector3 cross_of(Vector3 a, Vector3 b) {
  return {hn::NegMulAdd(a.z, b.y, hn::Mul(a.y, b.z)), hn::NegMulAdd(a.x, b.z, hn::Mul(a.z, b.x)),
          hn::NegMulAdd(a.y, b.x, hn::Mul(a.x, b.y))};
}
HWY_INLINE Vector3 normalised(D d, Vector3 a) {
  return scaled(a, hn::Div(number(d, 1), hn::Sqrt(dot(a, a))));
}
HWY_INLINE Vector3 moved(Vector3 a, V step, Vector3 along) {
  return {hn::MulAdd(step, along.x, a.x), hn::MulAdd(step, along.y, a.y), hn::MulAdd(step, along.z, a.z)};
}

// One light over the pixels.
struct LitLanes {
  Vector3 light, half;
  V fresnel, lobe_share;
};

// s pi D V F (n . l) of one family, 0 where the light is below the surface.
template <LobeFamily kFamily>
class LobeLanes {
 public:
  LobeLanes(D d, const Lobe& lobe) : d_(d), alpha_(number(d, lobe.alpha)) {
    const double a2 = lobe.alpha * lobe.alpha, along = lobe.alpha * lobe.along;
    alpha2_ = number(d, a2);
    inverse_alpha2_ = number(d, 1 / a2);
    rest_ = number(d, 1 - a2);
    along_ = number(d, along);
    inverse_along_ = number(d, 1 / along);
    inverse_alpha_ = number(d, 1 / lobe.alpha);
    inverse_product_ = number(d, 1 / (along * lobe.alpha));
    cloth_norm_ = number(d, 1 / (4 * (1 + 4 * a2)));
  }

  // A normal, with what all lights see of it.
  struct Facing {
    Vector3 normal, along, across;
    V view, view_term;
  };

  HWY_INLINE Facing facing(Vector3 normal, Vector3 view, V yarn_x, V yarn_y) const {
    Facing f;
    f.normal = normal;
    f.view = hn::Max(dot(normal, view), number(d_, 1e-6));
    if constexpr (kFamily == LobeFamily::kAnisotropicGgx) {
      const V lean = hn::Neg(hn::MulAdd(yarn_x, normal.x, hn::Mul(yarn_y, normal.y)));
      f.along = normalised(d_, {hn::Mul(yarn_x, normal.z), hn::Mul(yarn_y, normal.z), lean});
      f.across = cross_of(normal, f.along);
      f.view_term = smith(f, view, f.view);
    } else if constexpr (kFamily == LobeFamily::kGgx) {
      f.view_term = smith(f, view, f.view);
    } else if constexpr (kFamily == LobeFamily::kBeckmann) {
      f.view_term = hn::Div(unshadowed(f.view), f.view);
    } else {
      f.view_term = number(d_, 1);
    }
    return f;
  }

  HWY_INLINE V shine(const Facing& f, const LitLanes& from) const {
    if constexpr (kFamily == LobeFamily::kLambert) return hn::Zero(d_);
    const V cosine = dot(f.normal, from.light);
    const V lit = hn::Max(cosine, number(d_, 1e-6)), half = dot(f.normal, from.half);
    const V one = number(d_, 1), h2 = square_of(half);
    V reflected;
    if constexpr (kFamily == LobeFamily::kGgx) {
      const V spread = hn::MulAdd(hn::Sub(one, h2), inverse_alpha2_, h2);
      reflected = hn::Div(hn::Mul(inverse_alpha2_, hn::Mul(f.view_term, smith(f, from.light, lit))),
                          square_of(spread));
    } else if constexpr (kFamily == LobeFamily::kAnisotropicGgx) {
      const V x = hn::Mul(dot(from.half, f.along), inverse_along_),
              y = hn::Mul(dot(from.half, f.across), inverse_alpha_);
      const V spread = hn::MulAdd(x, x, hn::MulAdd(y, y, h2));
      reflected = hn::Div(hn::Mul(inverse_product_, hn::Mul(f.view_term, smith(f, from.light, lit))),
                          square_of(spread));
    } else if constexpr (kFamily == LobeFamily::kBeckmann) {
      const V c2 = square_of(hn::Max(half, number(d_, 1e-6)));
      const V falls = hn::Exp(d_, hn::Neg(hn::Mul(hn::Div(hn::Sub(one, c2), c2), inverse_alpha2_)));
      const V facets = hn::Div(hn::Mul(falls, inverse_alpha2_), square_of(c2));
      reflected =
          hn::Mul(hn::Mul(number(d_, 0.25), facets), hn::Mul(f.view_term, hn::Div(unshadowed(lit), lit)));
    } else {
      const V s2 = hn::Max(hn::Sub(one, h2), number(d_, 1e-12));
      const V falls = hn::Exp(d_, hn::Neg(hn::Mul(hn::Div(h2, s2), inverse_alpha2_)));
      const V facets = hn::MulAdd(number(d_, 4), hn::Div(falls, square_of(s2)), one);
      const V beside = hn::NegMulAdd(lit, f.view, hn::Add(lit, f.view));
      reflected = hn::Div(hn::Mul(cloth_norm_, facets), hn::Max(beside, number(d_, 1e-4)));
    }
    const V all = hn::Mul(hn::Mul(hn::Mul(cosine, from.fresnel), reflected), from.lobe_share);
    return hn::IfThenElseZero(hn::Gt(cosine, hn::Zero(d_)), all);
  }

 private:
  HWY_INLINE V smith(const Facing& f, Vector3 direction, V cosine) const {
    V root;
    if constexpr (kFamily == LobeFamily::kAnisotropicGgx) {
      const V x = hn::Mul(along_, dot(direction, f.along)), y = hn::Mul(alpha_, dot(direction, f.across));
      root = hn::MulAdd(x, x, hn::MulAdd(y, y, square_of(cosine)));
    } else {
      root = hn::MulAdd(rest_, square_of(cosine), alpha2_);
    }
    return hn::Div(number(d_, 1), hn::Add(cosine, hn::Sqrt(root)));
  }
  HWY_INLINE V unshadowed(V cosine) const {
    const V one = number(d_, 1);
    const V sine2 = hn::Max(hn::NegMulAdd(cosine, cosine, one), number(d_, 1e-12));
    const V q = hn::Div(hn::Mul(cosine, inverse_alpha_), hn::Sqrt(sine2));
    const V above = hn::Mul(q, hn::MulAdd(number(d_, 2.181), q, number(d_, 3.535)));
    const V below = hn::MulAdd(q, hn::MulAdd(number(d_, 2.577), q, number(d_, 2.276)), one);
    return hn::IfThenElse(hn::Lt(q, number(d_, 1.6)), hn::Min(hn::Div(above, below), one), one);
  }

  D d_;
  V alpha_, alpha2_, inverse_alpha2_, rest_, along_, inverse_along_, inverse_alpha_, inverse_product_,
      cloth_norm_;
};

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();

#endif
