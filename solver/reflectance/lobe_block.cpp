// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/lobe_block.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/reflectance/lobe_block.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first.
#include <hwy/highway.h>

#include "solver/reflectance/lobe-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft::solver {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Turn of the normal that a lobe's slope is taken from: what float32 can tell of it.
constexpr float kTurn = 1e-3F;
constexpr float kMostStep = 0.3F;
constexpr int kMostHalvings = 4;
// Of the cost: a step that wins less is the last.
constexpr float kLeastFall = 1e-6F;

// One vector of pixels of a block.
template <LobeFamily kFamily>
class LanesFit {
 public:
  LanesFit(D d, const Lobe& lobe, LobeBlock& block, std::size_t at)
      : d_(d),
        lobe_(d, lobe),
        bend_(number(d, lobe.bend)),
        f0_(number(d, lobe.f0)),
        block_(block),
        at_(at),
        view_(load(block.view)) {
    const V cosine = number(d, std::cos(lobe.axis)), sine = number(d, std::sin(lobe.axis));
    const V x = hn::LoadU(d, block.yarn_x.data() + at), y = hn::LoadU(d, block.yarn_y.data() + at);
    yarn_x_ = hn::NegMulAdd(sine, y, hn::Mul(cosine, x));
    yarn_y_ = hn::MulAdd(sine, x, hn::Mul(cosine, y));
  }

  void run(int steps) {
    Vector3 b = load(block_.solved);
    V cost = cost_of(b);
    M active = hn::Ge(cost, hn::Zero(d_));
    for (int i = 0; i < steps && !hn::AllFalse(d_, active); ++i) {
      Vector3 step = newton_step(b);
      const V size = hn::Sqrt(dot(step, step)), most = hn::Mul(hn::Set(d_, kMostStep), hn::Sqrt(dot(b, b)));
      active = hn::And(active, hn::Lt(size, hn::Inf(d_)));
      step = scaled(step, hn::IfThenElse(hn::Gt(size, most), hn::Div(most, size), number(d_, 1)));
      V tried = cost_of(moved(b, number(d_, 1), step));
      for (int halved = 0; halved < kMostHalvings; ++halved) {
        const M dearer = hn::And(active, hn::Gt(tried, cost));
        if (hn::AllFalse(d_, dearer)) break;
        const Vector3 half = scaled(step, number(d_, 0.5));
        step = {hn::IfThenElse(dearer, half.x, step.x), hn::IfThenElse(dearer, half.y, step.y),
                hn::IfThenElse(dearer, half.z, step.z)};
        tried = hn::IfThenElse(dearer, cost_of(moved(b, number(d_, 1), step)), tried);
      }
      active = hn::And(active, hn::Lt(tried, cost));
      b = moved(b, number(d_, 1), masked(active, step));
      const V won = hn::Sub(cost, tried);
      cost = hn::IfThenElse(active, tried, cost);
      active = hn::And(active, hn::Ge(won, hn::Mul(hn::Set(d_, kLeastFall), cost)));
    }
    store(b, block_.solved);
    hn::StoreU(cost, d_, block_.cost.data() + at_);
    const NormalSums sums = sums_of(b);
    hn::StoreU(hn::Sqrt(hn::Div(sums.square, hn::Max(sums.used, number(d_, 1)))), d_,
               block_.residual.data() + at_);
    const Symmetric m = sums.matrix;
    const V elements[] = {m.xx, m.xy, m.xz, m.yy, m.yz, m.zz};
    for (std::size_t i = 0; i < 6; ++i) hn::StoreU(elements[i], d_, block_.normal_matrix[i].data() + at_);
  }

  void write_pull(const LanesFit& other, LobeBlock::Lanes3& pull) const {
    const Turned turned = turned_at(load(block_.solved));
    const Facing facing = other.facing_of(turned.n);
    Vector3 sum = zero_vector(d_);
    for (const LobeBlock::Light& light : block_.lights()) {
      const Linear r = linear(light, turned);
      const V off = hn::Sub(other.modelled(facing, turned.rho, other.lit_by(light)), r.model);
      add_scaled(sum, off, scaled(r.by_b, r.weight));
    }
    store(sum, pull);
  }

 private:
  using Facing = typename LobeLanes<kFamily>::Facing;
  struct NormalSums {
    Symmetric matrix;
    Vector3 gradient;
    V square, used;  // of residuals, and how many
  };

  HWY_INLINE Vector3 load(const LobeBlock::Lanes3& v) const {
    return {hn::LoadU(d_, v.x.data() + at_), hn::LoadU(d_, v.y.data() + at_),
            hn::LoadU(d_, v.z.data() + at_)};
  }
  HWY_INLINE void store(Vector3 v, LobeBlock::Lanes3& into) const {
    hn::StoreU(v.x, d_, into.x.data() + at_);
    hn::StoreU(v.y, d_, into.y.data() + at_);
    hn::StoreU(v.z, d_, into.z.data() + at_);
  }
  HWY_INLINE LitLanes lit_by(const LobeBlock::Light& light) const {
    V fresnel = hn::Zero(d_), share = hn::Zero(d_);
    if constexpr (kFamily != LobeFamily::kLambert) {
      const V grazing = hn::LoadU(d_, light.grazing.data() + at_);
      fresnel = hn::MulAdd(hn::Sub(number(d_, 1), f0_), grazing, f0_);
      share = hn::LoadU(d_, light.lobe_share.data() + at_);
    }
    return {load(light.to_light), load(light.half), fresnel, share};
  }

  // The part of rho (n . l) that the diffuse part sends on, without rho.
  struct Diffuse {
    V cosine, beneath, straight;
    HWY_INLINE V share() const { return hn::Mul(hn::Mul(cosine, beneath), straight); }
  };
  HWY_INLINE Diffuse diffuse(Vector3 n, const LitLanes& from) const {
    const V cosine = hn::Max(dot(n, from.light), hn::Zero(d_)), one = number(d_, 1);
    return {cosine, hn::Sub(one, from.fresnel), hn::NegMulAdd(bend_, hn::Sub(one, cosine), one)};
  }

  HWY_INLINE Facing facing_of(Vector3 n) const { return lobe_.facing(n, view_, yarn_x_, yarn_y_); }
  HWY_INLINE V modelled(const Facing& facing, V rho, const LitLanes& from) const {
    return hn::MulAdd(rho, diffuse(facing.normal, from).share(), lobe_.shine(facing, from));
  }

  V cost_of(Vector3 b) const {
    const V rho = hn::Max(hn::Sqrt(dot(b, b)), number(d_, 1e-12)), one = number(d_, 1);
    const Facing facing = facing_of(scaled(b, hn::Div(one, rho)));
    V cost = hn::Zero(d_);
    const V huber = number(d_, kHuberSigmas);
    for (const LobeBlock::Light& light : block_.lights()) {
      const V model = modelled(facing, rho, lit_by(light));
      const V w = hn::LoadU(d_, light.weight.data() + at_);
      const V size = hn::Mul(hn::Abs(hn::Sub(hn::LoadU(d_, light.reading.data() + at_), model)), hn::Sqrt(w));
      const V inner = hn::Min(size, huber);
      // Half of the square up to Huber's limit, its tangent beyond.
      cost = hn::Add(cost, hn::Mul(inner, hn::NegMulAdd(number(d_, 0.5), inner, size)));
    }
    return cost;
  }

  // Pixels at b, and with normals turned to both sides, which slopes are taken from.
  struct Turned {
    Vector3 n, first, second;
    V rho, by_turn;
    Facing here, to_first, to_second;
  };
  HWY_INLINE Turned turned_at(Vector3 b) const {
    const V one = number(d_, 1), zero = hn::Zero(d_);
    Turned t;
    t.rho = hn::Max(hn::Sqrt(dot(b, b)), number(d_, 1e-12));
    const V inverse_rho = hn::Div(one, t.rho);
    t.n = scaled(b, inverse_rho);
    // The axis that is least along the normal, for two directions across it.
    const M is_up = hn::Gt(hn::Abs(t.n.z), number(d_, 0.5));
    const Vector3 aside = {hn::IfThenElseZero(is_up, one), zero, hn::IfThenZeroElse(is_up, one)};
    t.first = normalised(d_, cross_of(aside, t.n));
    t.second = cross_of(t.n, t.first);
    const V turn = hn::Set(d_, kTurn);
    t.here = facing_of(t.n);
    t.to_first = facing_of(normalised(d_, moved(t.n, turn, t.first)));
    t.to_second = facing_of(normalised(d_, moved(t.n, turn, t.second)));
    t.by_turn = hn::Mul(inverse_rho, hn::Set(d_, 1 / kTurn));
    return t;
  }

  // One reading there, with the derivative of its model by b.
  struct Linear {
    V model, residual, weight;  // Huber's weight
    M is_used;
    Vector3 by_b;
  };
  HWY_INLINE Linear linear(const LobeBlock::Light& light, const Turned& t) const {
    const LitLanes from = lit_by(light);
    const Diffuse part = diffuse(t.n, from);
    const V shine = lobe_.shine(t.here, from);
    Linear reading;
    reading.model = hn::MulAdd(t.rho, part.share(), shine);
    reading.residual = hn::Sub(hn::LoadU(d_, light.reading.data() + at_), reading.model);
    const V bent = hn::Mul(hn::Mul(bend_, part.cosine), part.beneath);
    Vector3 j = scaled(from.light, hn::MulAdd(part.beneath, part.straight, bent));
    j = moved(j, hn::Neg(hn::Mul(bent, part.cosine)), t.n);
    j = masked(hn::Gt(part.cosine, hn::Zero(d_)), j);
    j = moved(j, hn::Mul(hn::Sub(lobe_.shine(t.to_first, from), shine), t.by_turn), t.first);
    reading.by_b = moved(j, hn::Mul(hn::Sub(lobe_.shine(t.to_second, from), shine), t.by_turn), t.second);
    const V w = hn::LoadU(d_, light.weight.data() + at_), huber = number(d_, kHuberSigmas);
    reading.is_used = hn::Gt(w, hn::Zero(d_));
    const V size = hn::Mul(hn::Abs(reading.residual), hn::Sqrt(w));
    reading.weight = hn::IfThenElse(hn::Lt(size, huber), w, hn::Div(hn::Mul(w, huber), hn::Max(size, huber)));
    return reading;
  }

  NormalSums sums_of(Vector3 b) const {
    const V one = number(d_, 1), zero = hn::Zero(d_);
    const Turned turned = turned_at(b);
    NormalSums sums = {zero_matrix(d_), zero_vector(d_), zero, zero};
    for (const LobeBlock::Light& light : block_.lights()) {
      const Linear r = linear(light, turned);
      sums.square = hn::Add(sums.square, hn::IfThenElseZero(r.is_used, square_of(r.residual)));
      sums.used = hn::Add(sums.used, hn::IfThenElseZero(r.is_used, one));
      const Vector3 wj = scaled(r.by_b, r.weight);
      add_outer(sums.matrix, wj, r.by_b);
      add_scaled(sums.gradient, r.residual, wj);
    }
    const V little = hn::MulAdd(number(d_, 1e-6), trace(sums.matrix), number(d_, 1e-30));
    sums.matrix.xx = hn::Add(sums.matrix.xx, little);
    sums.matrix.yy = hn::Add(sums.matrix.yy, little);
    sums.matrix.zz = hn::Add(sums.matrix.zz, little);
    return sums;
  }

  Vector3 newton_step(Vector3 b) const {
    const NormalSums sums = sums_of(b);
    // Scaled to a trace of 1, since the determinant of large weights leaves the range of float32.
    const V scale = hn::Div(number(d_, 1), trace(sums.matrix));
    const Symmetric& m = sums.matrix;
    const Symmetric unit = {hn::Mul(m.xx, scale), hn::Mul(m.xy, scale), hn::Mul(m.xz, scale),
                            hn::Mul(m.yy, scale), hn::Mul(m.yz, scale), hn::Mul(m.zz, scale)};
    return times(inverted(d_, unit).matrix, scaled(sums.gradient, scale));
  }

  D d_;
  LobeLanes<kFamily> lobe_;
  V bend_, f0_;
  LobeBlock& block_;
  std::size_t at_;
  Vector3 view_;
  V yarn_x_, yarn_y_;
};

// Calls `work` with the family as a constant.
template <typename Work>
void for_family(LobeFamily family, const Work& work) {
  switch (family) {
    case LobeFamily::kLambert:
      return work.template operator()<LobeFamily::kLambert>();
    case LobeFamily::kGgx:
      return work.template operator()<LobeFamily::kGgx>();
    case LobeFamily::kAnisotropicGgx:
      return work.template operator()<LobeFamily::kAnisotropicGgx>();
    case LobeFamily::kBeckmann:
      return work.template operator()<LobeFamily::kBeckmann>();
    case LobeFamily::kCloth:
      return work.template operator()<LobeFamily::kCloth>();
  }
}

void fit_block_lanes(const Lobe& lobe, LobeBlock& block, int steps) {
  const D d;
  for_family(lobe.family, [&]<LobeFamily kFamily>() {
    for (std::size_t at = 0; at < LobeBlock::kPixels; at += hn::Lanes(d))
      LanesFit<kFamily>(d, lobe, block, at).run(steps);
  });
}

void pull_block_lanes(const Lobe& lobe, const Lobe& other, LobeBlock& block, LobeBlock::Lanes3& pull) {
  const D d;
  for_family(lobe.family, [&]<LobeFamily kFamily>() {
    for (std::size_t at = 0; at < LobeBlock::kPixels; at += hn::Lanes(d)) {
      LanesFit<kFamily>(d, lobe, block, at).write_pull(LanesFit<kFamily>(d, other, block, at), pull);
    }
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace weft::solver {

HWY_EXPORT(fit_block_lanes);
HWY_EXPORT(pull_block_lanes);

void fit_block(const Lobe& lobe, LobeBlock& block, int steps) {
  HWY_DYNAMIC_DISPATCH(fit_block_lanes)(lobe, block, steps);
}

LobeBlock::Lanes3 pull_of(const Lobe& other, const Lobe& lobe, LobeBlock& block) {
  LobeBlock::Lanes3 pull;
  HWY_DYNAMIC_DISPATCH(pull_block_lanes)(lobe, other, block, pull);
  return pull;
}

void LobeBlock::put(std::size_t pixel, std::span<const LobeReading> readings) {
  const auto write = [pixel](Lanes3& into, Vec3 v) {
    into.x[pixel] = static_cast<float>(v.x);
    into.y[pixel] = static_cast<float>(v.y);
    into.z[pixel] = static_cast<float>(v.z);
  };
  for (std::size_t k = 0; k < lights_.size(); ++k) {
    const LobeReading& r = readings[k];
    Light& light = lights_[k];
    write(light.to_light, r.from.light);
    write(light.half, r.from.half);
    light.lobe_share[pixel] = static_cast<float>(r.from.lobe_share);
    light.grazing[pixel] = static_cast<float>(std::pow(1 - r.from.light_half, 5));
    light.weight[pixel] = static_cast<float>(r.weight);
    light.reading[pixel] = r.weight > 0 ? static_cast<float>(r.x) : 0.0F;
  }
  write(view, readings.front().from.view);
}

void LobeBlock::start(std::size_t pixel, Vec3 b, double yarn) {
  solved.x[pixel] = static_cast<float>(b.x);
  solved.y[pixel] = static_cast<float>(b.y);
  solved.z[pixel] = static_cast<float>(b.z);
  yarn_x[pixel] = static_cast<float>(std::cos(yarn));
  yarn_y[pixel] = static_cast<float>(std::sin(yarn));
}

void LobeBlock::take(std::size_t pixel, const LobeBlock& other) {
  const auto copy = [pixel](Lane& into, const Lane& from) { into[pixel] = from[pixel]; };
  copy(solved.x, other.solved.x);
  copy(solved.y, other.solved.y);
  copy(solved.z, other.solved.z);
  copy(yarn_x, other.yarn_x);
  copy(yarn_y, other.yarn_y);
  copy(cost, other.cost);
  copy(residual, other.residual);
  lobe[pixel] = other.lobe[pixel];
  for (std::size_t i = 0; i < normal_matrix.size(); ++i) copy(normal_matrix[i], other.normal_matrix[i]);
}

Vec3 LobeBlock::b(std::size_t pixel) const {
  return {solved.x[pixel], solved.y[pixel], solved.z[pixel]};
}

}  // namespace weft::solver
#endif
