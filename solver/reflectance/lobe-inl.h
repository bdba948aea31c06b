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
HWY_INLINE Vector3 moved(Vector3 a, V step, Vector3 along) {
  return {hn::MulAdd(step, along.x, a.x), hn::MulAdd(step, along.y, a.y), hn::MulAdd(step, along.z, a.z)};
}

// A normal, the yarn's direction in the surface, and the direction across it. Turned by a small angle e
// towards `along`, along becomes along + e (twist across - normal) and across becomes across - e twist along.
// Turned towards `across`, along stays and across becomes across - e normal.
struct Frame {
  Vector3 normal, along, across;
  V twist;
};

// The yarn's azimuth as cosine and sine.
HWY_INLINE Frame frame_of(D d, Vector3 normal, V yarn_x, V yarn_y) {
  Frame f;
  f.normal = normal;
  // Beside the yarn in the plane of the rig, times the normal.
  const Vector3 u = {hn::Mul(yarn_x, normal.z), hn::Mul(yarn_y, normal.z),
                     hn::Neg(hn::MulAdd(yarn_x, normal.x, hn::Mul(yarn_y, normal.y)))};
  // Nothing is left of u on an upright surface along the yarn: the yarn lies in it as it is.
  const V squared = dot(u, u), least = number(d, 1e-12), zero = hn::Zero(d);
  const M is_upright = hn::Lt(squared, least);
  const V inverse = hn::Div(number(d, 1), hn::Sqrt(hn::Max(squared, least)));
  f.along = {hn::IfThenElse(is_upright, yarn_x, hn::Mul(u.x, inverse)),
             hn::IfThenElse(is_upright, yarn_y, hn::Mul(u.y, inverse)),
             hn::IfThenElse(is_upright, zero, hn::Mul(u.z, inverse))};
  f.across = cross_of(normal, f.along);
  f.twist =
      hn::Mul(hn::Min(inverse, number(d, 1e3)), hn::NegMulAdd(yarn_y, normal.x, hn::Mul(yarn_x, normal.y)));
  return f;
}

// A unit vector in a frame.
struct Toward {
  V normal, along, across;
};
HWY_INLINE Toward toward(const Frame& f, Vector3 direction) {
  return {dot(f.normal, direction), dot(f.along, direction), dot(f.across, direction)};
}

// s pi D V F (n . l) of one family, 0 where the light is below the surface.
template <LobeFamily kFamily>
class LobeLanes {
 public:
  LobeLanes(D d, const Lobe& lobe) : d_(d) {
    const double along = kFamily == LobeFamily::kAnisotropicGgx ? lobe.along : 1;
    const double across2 = lobe.alpha * lobe.alpha, along2 = across2 * along * along;
    across2_ = number(d, across2);
    along2_ = number(d, along2);
    inverse_alpha_ = number(d, 1 / lobe.alpha);
    inverse_across2_ = number(d, 1 / across2);
    inverse_along2_ = number(d, 1 / along2);
    inverse_product_ = number(d, 1 / (across2 * along));
    cloth_norm_ = number(d, 1 / (4 * (1 + 4 * across2)));
  }

  // What all lights see of a normal: its shadowing towards the camera, with slopes of that by a turn.
  struct Seen {
    V cosine, term, by_along, by_across;
  };
  struct Shine {
    V value, by_along, by_across;
  };

  HWY_INLINE Seen seen(const Frame& f, Vector3 to_camera) const {
    const Toward to = toward(f, to_camera);
    const V one = number(d_, 1);
    Seen v;
    v.cosine = hn::Max(to.normal, number(d_, 1e-6));
    if constexpr (kIsGgx) {
      const V root = root_of(to, v.cosine);
      v.term = hn::Div(one, hn::Add(v.cosine, root));
      const V inverse_root = hn::Div(one, root), fall = hn::Neg(square_of(v.term));
      v.by_along = hn::Mul(fall, hn::Mul(to.along, root_by_along(f, to, v.cosine, inverse_root)));
      v.by_across = hn::Mul(fall, hn::Mul(to.across, root_by_across(v.cosine, inverse_root)));
    } else if constexpr (kFamily == LobeFamily::kBeckmann) {
      const Unshadowed u = unshadowed(v.cosine);
      v.term = u.value;
      v.by_along = hn::Mul(u.by_cosine, to.along);
      v.by_across = hn::Mul(u.by_cosine, to.across);
    } else {
      v.term = one;
      v.by_along = to.along;  // of the cosine
      v.by_across = to.across;
    }
    return v;
  }

  // `strength`: Fresnel's share times that of the lobe.
  HWY_INLINE Shine shine(const Frame& f, const Seen& view, const Toward& light, const Toward& half,
                         V strength) const {
    const V zero = hn::Zero(d_);
    if constexpr (kFamily == LobeFamily::kLambert) return {zero, zero, zero};
    Shine s;
    if constexpr (kIsGgx) {
      s = ggx(f, view, light, half);
    } else if constexpr (kFamily == LobeFamily::kBeckmann) {
      s = beckmann(view, light, half);
    } else {
      s = cloth(view, light, half);
    }
    // Times n . l, and its slope.
    const V lit = hn::IfThenElseZero(hn::Gt(light.normal, zero), strength);
    const V factor = hn::Mul(lit, light.normal), value = hn::Mul(lit, s.value);
    return {hn::Mul(factor, s.value), hn::MulAdd(factor, s.by_along, hn::Mul(value, light.along)),
            hn::MulAdd(factor, s.by_across, hn::Mul(value, light.across))};
  }

 private:
  static constexpr bool kIsGgx = kFamily == LobeFamily::kGgx || kFamily == LobeFamily::kAnisotropicGgx;

  // Smith's shadowing is 1 / (cosine + root).
  HWY_INLINE V root_of(const Toward& to, V cosine) const {
    const V along = hn::Mul(hn::Mul(along2_, to.along), to.along);
    return hn::Sqrt(hn::MulAdd(hn::Mul(across2_, to.across), to.across, hn::MulAdd(cosine, cosine, along)));
  }
  // Slopes of cosine + root over the direction's own component.
  HWY_INLINE V root_by_along(const Frame& f, const Toward& to, V cosine, V inverse_root) const {
    const V one = number(d_, 1);
    const V twisted = hn::Mul(hn::Mul(f.twist, to.across), hn::Sub(along2_, across2_));
    return hn::MulAdd(hn::MulAdd(cosine, hn::Sub(one, along2_), twisted), inverse_root, one);
  }
  HWY_INLINE V root_by_across(V cosine, V inverse_root) const {
    const V one = number(d_, 1);
    return hn::MulAdd(hn::Mul(cosine, hn::Sub(one, across2_)), inverse_root, one);
  }

  HWY_INLINE Shine ggx(const Frame& f, const Seen& view, const Toward& light, const Toward& half) const {
    const V one = number(d_, 1), lit = hn::Max(light.normal, number(d_, 1e-6));
    const V root = root_of(light, lit), sum = hn::Add(lit, root);
    const V x = hn::Mul(inverse_along2_, half.along), y = hn::Mul(inverse_across2_, half.across);
    const V spread = hn::MulAdd(x, half.along, hn::MulAdd(y, half.across, square_of(half.normal)));
    // One division for three.
    const V sum_spread = hn::Mul(sum, spread), all = hn::Div(one, hn::Mul(sum_spread, root));
    const V inverse_root = hn::Mul(all, sum_spread), inverse_spread = hn::Mul(all, hn::Mul(sum, root)),
            shadow = hn::Mul(all, hn::Mul(spread, root));
    const V unseen = hn::Mul(inverse_product_, hn::Mul(shadow, square_of(inverse_spread)));
    const V twisted = hn::Mul(hn::Mul(f.twist, half.across), hn::Sub(inverse_along2_, inverse_across2_));
    const V half_along = hn::Mul(half.along, hn::MulAdd(half.normal, hn::Sub(one, inverse_along2_), twisted));
    const V half_across = hn::Mul(hn::Mul(half.across, half.normal), hn::Sub(one, inverse_across2_));
    const V by_half = hn::Mul(number(d_, -4), inverse_spread);
    // Slopes of the logarithm.
    const V by_along = hn::NegMulAdd(hn::Mul(shadow, light.along), root_by_along(f, light, lit, inverse_root),
                                     hn::Mul(by_half, half_along));
    const V by_across = hn::NegMulAdd(hn::Mul(shadow, light.across), root_by_across(lit, inverse_root),
                                      hn::Mul(by_half, half_across));
    const V value = hn::Mul(unseen, view.term);
    return {value, hn::MulAdd(value, by_along, hn::Mul(unseen, view.by_along)),
            hn::MulAdd(value, by_across, hn::Mul(unseen, view.by_across))};
  }

  HWY_INLINE Shine beckmann(const Seen& view, const Toward& light, const Toward& half) const {
    const V one = number(d_, 1), c = hn::Max(half.normal, number(d_, 1e-6)), c2 = square_of(c);
    const V inverse_c2 = hn::Div(one, c2), falls_by = hn::Mul(inverse_c2, inverse_across2_);
    const V falls = hn::Exp(d_, hn::Neg(hn::Mul(hn::Sub(one, c2), falls_by)));
    const V facets =
        hn::Mul(hn::Mul(falls, hn::Mul(number(d_, 0.25), inverse_across2_)), square_of(inverse_c2));
    // 2 / (alpha^2 c^3) - 4 / c, of the logarithm.
    const V by_half = hn::Mul(hn::MulAdd(number(d_, 2), falls_by, number(d_, -4)), hn::Mul(c, inverse_c2));
    const Unshadowed lit = unshadowed(hn::Max(light.normal, number(d_, 1e-6)));
    const V value = hn::Mul(facets, hn::Mul(lit.value, view.term));
    const V by_light = hn::Mul(hn::Mul(facets, view.term), lit.by_cosine),
            by_view = hn::Mul(facets, lit.value), by_h = hn::Mul(value, by_half);
    return {
        value,
        hn::MulAdd(by_light, light.along, hn::MulAdd(by_view, view.by_along, hn::Mul(by_h, half.along))),
        hn::MulAdd(by_light, light.across, hn::MulAdd(by_view, view.by_across, hn::Mul(by_h, half.across)))};
  }

  HWY_INLINE Shine cloth(const Seen& view, const Toward& light, const Toward& half) const {
    const V one = number(d_, 1), four = number(d_, 4), lit = hn::Max(light.normal, number(d_, 1e-6));
    const V h2 = square_of(half.normal), s2 = hn::Max(hn::Sub(one, h2), number(d_, 1e-12));
    const V inverse_s2 = hn::Div(one, s2), inverse_s4 = square_of(inverse_s2);
    const V falls = hn::Exp(d_, hn::Neg(hn::Mul(hn::Mul(h2, inverse_s2), inverse_across2_)));
    const V fuzz = hn::Mul(hn::Mul(four, falls), inverse_s4);
    // 4 / sin^2 - 2 / (alpha^2 sin^4), of the logarithm, times the cosine.
    const V by_cosine =
        hn::NegMulAdd(hn::Mul(number(d_, 2), inverse_across2_), inverse_s4, hn::Mul(four, inverse_s2));
    const V beside = hn::Max(hn::NegMulAdd(lit, view.cosine, hn::Add(lit, view.cosine)), number(d_, 1e-4));
    const V scale = hn::Div(cloth_norm_, beside), value = hn::Mul(scale, hn::Add(one, fuzz));
    const V by_h = hn::Mul(hn::Mul(hn::Mul(scale, fuzz), by_cosine), half.normal);
    const V fall = hn::Neg(hn::Div(value, beside));
    const V by_light = hn::Mul(fall, hn::Sub(one, view.cosine)), by_view = hn::Mul(fall, hn::Sub(one, lit));
    return {
        value,
        hn::MulAdd(by_light, light.along, hn::MulAdd(by_view, view.by_along, hn::Mul(by_h, half.along))),
        hn::MulAdd(by_light, light.across, hn::MulAdd(by_view, view.by_across, hn::Mul(by_h, half.across)))};
  }

  // Walter's fit of Smith's shadowing, over the cosine.
  struct Unshadowed {
    V value, by_cosine;
  };
  HWY_INLINE Unshadowed unshadowed(V cosine) const {
    const V one = number(d_, 1), zero = hn::Zero(d_);
    const V sine2 = hn::Max(hn::NegMulAdd(cosine, cosine, one), number(d_, 1e-12));
    const V q_by_cosine = hn::Div(inverse_alpha_, hn::Mul(sine2, hn::Sqrt(sine2)));
    const V q = hn::Mul(hn::Mul(q_by_cosine, sine2), cosine);
    const V above = hn::Mul(q, hn::MulAdd(number(d_, 2.181), q, number(d_, 3.535)));
    const V below = hn::MulAdd(q, hn::MulAdd(number(d_, 2.577), q, number(d_, 2.276)), one);
    const V inverse_below = hn::Div(one, below), ratio = hn::Mul(above, inverse_below);
    const M is_steep = hn::And(hn::Lt(q, number(d_, 1.6)), hn::Lt(ratio, one));
    const V passes = hn::IfThenElse(is_steep, ratio, one);
    const V above_by_q = hn::MulAdd(number(d_, 4.362), q, number(d_, 3.535));
    const V below_by_q = hn::MulAdd(number(d_, 5.154), q, number(d_, 2.276));
    const V by_q = hn::Mul(hn::NegMulAdd(ratio, below_by_q, above_by_q), inverse_below);
    const V by_cosine = hn::IfThenElse(is_steep, hn::Mul(by_q, q_by_cosine), zero);
    const V inverse_cosine = hn::Div(one, cosine), value = hn::Mul(passes, inverse_cosine);
    return {value, hn::Mul(hn::Sub(by_cosine, value), inverse_cosine)};
  }

  D d_;
  V across2_, along2_, inverse_alpha_, inverse_across2_, inverse_along2_, inverse_product_, cloth_norm_;
};

template <>
class LobeLanes<LobeFamily::kTwoGgx> {
 public:
  using Part = LobeLanes<LobeFamily::kGgx>;
  using Shine = Part::Shine;
  struct Seen {
    Part::Seen sharp, broad;
  };

  LobeLanes(D d, const Lobe& lobe)
      : sharp_(d, lobe.sharp_part()),
        broad_(d, lobe.broad_part()),
        sharp_share_(number(d, 1 - lobe.broad_share)),
        broad_share_(number(d, lobe.broad_share)) {}

  HWY_INLINE Seen seen(const Frame& f, Vector3 to_camera) const {
    return {sharp_.seen(f, to_camera), broad_.seen(f, to_camera)};
  }

  HWY_INLINE Shine shine(const Frame& f, const Seen& view, const Toward& light, const Toward& half,
                         V strength) const {
    const Shine a = sharp_.shine(f, view.sharp, light, half, hn::Mul(sharp_share_, strength)),
                b = broad_.shine(f, view.broad, light, half, hn::Mul(broad_share_, strength));
    return {hn::Add(a.value, b.value), hn::Add(a.by_along, b.by_along), hn::Add(a.by_across, b.by_across)};
  }

 private:
  Part sharp_, broad_;
  V sharp_share_, broad_share_;
};

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();

#endif
