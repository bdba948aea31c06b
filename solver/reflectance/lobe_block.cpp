// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/lobe_block.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

// As in pixel_fit.cpp, whose lanes these are.
constexpr float kMostStep = 0.3F;
constexpr int kMostHalvings = 4;
// Evaluations from one start, in rounds between which yarns and starts are compared.
constexpr int kRounds = 5, kStepsOfRound = 2;
// The next step is the last where it should win no more than this and a share of the cost: it moves b by a
// fiftieth of its sigma.
struct Last {
  float wins, share;
};
constexpr Last kToSigma = {2e-4F, 1e-5F}, kToRounding = {0, 1e-7F};
// And where it is no longer than this share of b: further off the prediction counts for nothing.
constexpr float kLastStep = 0.03F;
// A fit is given up where so many times what its next step should win leave it dearer than another.
constexpr float kHope = 4;

// A factor of a symmetric matrix, L D L^T.
struct Factor {
  V inverse_d0, inverse_d1, inverse_d2, l10, l20, l21;
};

HWY_INLINE Factor factor_of(D d, const Symmetric& m) {
  const V one = number(d, 1), least = hn::MulAdd(number(d, 1e-7), trace(m), number(d, 1e-30));
  Factor f;
  f.inverse_d0 = hn::Div(one, hn::Max(m.xx, least));
  f.l10 = hn::Mul(m.xy, f.inverse_d0);
  f.l20 = hn::Mul(m.xz, f.inverse_d0);
  f.inverse_d1 = hn::Div(one, hn::Max(hn::NegMulAdd(f.l10, m.xy, m.yy), least));
  const V rest = hn::NegMulAdd(f.l20, m.xy, m.yz);
  f.l21 = hn::Mul(rest, f.inverse_d1);
  const V d2 = hn::NegMulAdd(f.l21, rest, hn::NegMulAdd(f.l20, m.xz, m.zz));
  f.inverse_d2 = hn::Div(one, hn::Max(d2, least));
  return f;
}

HWY_INLINE Vector3 solved_by(const Factor& f, Vector3 right) {
  const V y = hn::NegMulAdd(f.l10, right.x, right.y);
  const V z = hn::NegMulAdd(f.l21, y, hn::NegMulAdd(f.l20, right.x, right.z));
  Vector3 x;
  x.z = hn::Mul(z, f.inverse_d2);
  x.y = hn::NegMulAdd(f.l21, x.z, hn::Mul(y, f.inverse_d1));
  x.x = hn::NegMulAdd(f.l20, x.z, hn::NegMulAdd(f.l10, x.y, hn::Mul(right.x, f.inverse_d0)));
  return x;
}

HWY_INLINE V blended(M where, V a, V b) {
  return hn::IfThenElse(where, a, b);
}
HWY_INLINE Vector3 blended(M where, Vector3 a, Vector3 b) {
  return {blended(where, a.x, b.x), blended(where, a.y, b.y), blended(where, a.z, b.z)};
}
HWY_INLINE Symmetric blended(M where, const Symmetric& a, const Symmetric& b) {
  return {blended(where, a.xx, b.xx), blended(where, a.xy, b.xy), blended(where, a.xz, b.xz),
          blended(where, a.yy, b.yy), blended(where, a.yz, b.yz), blended(where, a.zz, b.zz)};
}

// One vector of pixels of a block, by one lobe.
template <LobeFamily kFamily>
class LanesFit {
 public:
  // Azimuths of a yarn.
  struct Yarn {
    V x, y;
  };

  LanesFit(D d, const Lobe& lobe, const LobeBlock& block, std::size_t at, Last last = kToSigma)
      : d_(d),
        last_(last),
        lobe_(d, lobe),
        bend_(number(d, lobe.bend)),
        f0_(f0_lanes(d, lobe, block, at)),
        cosine_(std::cos(lobe.axis)),
        sine_(std::sin(lobe.axis)),
        block_(block),
        at_(at),
        view_(load(block.view)) {}

  void fit(LobeBlock& block, int steps) const {
    const V across = hn::LoadU(d_, block.across.data() + at_);
    Walk walk = begin(yarn_of(hn::Gt(across, hn::Zero(d_))));
    walk.left = hn::Set(d_, static_cast<float>(steps));
    advance(walk, steps + kMostHalvings);
    write(walk.at, hn::Inf(d_), across, block, 0);
  }

  void improve(LobeBlock& block, std::size_t index) const {
    const V best = hn::LoadU(d_, block.cost.data() + at_);
    const V zero = hn::Zero(d_);
    Walk along = begin({number(d_, cosine_), number(d_, sine_)});
    if constexpr (kFamily == LobeFamily::kAnisotropicGgx) {
      Walk across = begin({number(d_, -sine_), number(d_, cosine_)});
      for (int round = 0; round < kRounds; ++round) {
        advance(along, kStepsOfRound);
        advance(across, kStepsOfRound);
        give_up(along, hn::Min(best, across.at.cost));
        give_up(across, hn::Min(best, along.at.cost));
      }
      const M is_across = hn::Lt(across.at.cost, along.at.cost);
      take(is_across, across.at, along.at);
      write(along.at, best, hn::IfThenElseZero(is_across, number(d_, 1)), block, index);
    } else {
      for (int round = 0; round < kRounds; ++round) {
        advance(along, kStepsOfRound);
        give_up(along, best);
      }
      write(along.at, best, zero, block, index);
    }
  }

  void write_variances(std::span<const Lobe> one_sigma_off, BlockVariances& variances) const {
    const V is_across = hn::LoadU(d_, block_.across.data() + at_), zero = hn::Zero(d_);
    const M across = hn::Gt(is_across, zero);
    const Vector3 b = load(block_.solved);
    Symmetric m;
    V* const elements[] = {&m.xx, &m.xy, &m.xz, &m.yy, &m.yz, &m.zz};
    for (std::size_t i = 0; i < 6; ++i) *elements[i] = hn::LoadU(d_, block_.normal_matrix[i].data() + at_);
    const Factor f = factor_of(d_, m);
    // The diagonal of the inverse, by the inverse of L.
    const V l20 = hn::MulSub(f.l10, f.l21, f.l20);
    const V of_readings = hn::MulAdd(hn::Mul(f.l10, f.l10), f.inverse_d1,
                                     hn::MulAdd(hn::Mul(l20, l20), f.inverse_d2, f.inverse_d0));
    const V beside = hn::MulAdd(hn::Mul(f.l21, f.l21), f.inverse_d2, hn::Add(f.inverse_d1, f.inverse_d2));
    const Place place = place_of(b, yarn_of(across));
    V along_of_lobe = zero, across_of_lobe = zero;
    for (const Lobe& off : one_sigma_off) {
      const LanesFit other(d_, off, block_, at_);
      const Place other_place = other.place_of(b, other.yarn_of(across));
      Vector3 pull = zero_vector(d_);
      for (const LobeBlock::Light& light : block_.lights()) {
        const Linear r = linear(light, place);
        add_scaled(pull, hn::Mul(r.weight, hn::Sub(other.linear(light, other_place).model, r.model)), r.by_b);
      }
      const Vector3 change = solved_by(f, pull);
      along_of_lobe = hn::MulAdd(change.x, change.x, along_of_lobe);
      across_of_lobe = hn::MulAdd(change.y, change.y, hn::MulAdd(change.z, change.z, across_of_lobe));
    }
    store(of_readings, variances.along_of_readings);
    store(beside, variances.across_of_readings);
    store(along_of_lobe, variances.along_of_lobe);
    store(across_of_lobe, variances.across_of_lobe);
  }

  void add_shared(std::span<const NudgedLobe> nudged, std::size_t pixels, SharedEquations& sums) const {
    const M across = hn::Gt(hn::LoadU(d_, block_.across.data() + at_), hn::Zero(d_));
    const Vector3 b = load(block_.start);
    const Point point = point_at(b, yarn_of(across));
    const Place place = place_of(b, yarn_of(across));
    const V zero = hn::Zero(d_);
    // Slopes of one light after another by each value, then what they come to.
    Shared slopes[kLobeParameters];
    for (std::size_t p = 0; p < nudged.size(); ++p)
      slopes[p] = {zero, zero_vector(d_), {zero, zero, zero, zero, zero}};
    for (const LobeBlock::Light& light : block_.lights()) {
      const Linear r = linear(light, place);
      V slope[kLobeParameters];
      for (std::size_t p = 0; p < nudged.size(); ++p) {
        const LanesFit other(d_, nudged[p].lobe, block_, at_);
        const V there = other.linear(light, other.place_of(b, other.yarn_of(across))).model;
        slope[p] = hn::Mul(hn::Sub(there, r.model), number(d_, 1 / nudged[p].by));
        const V weighted = hn::Mul(r.weight, slope[p]);
        slopes[p].gradient = hn::MulAdd(weighted, r.residual, slopes[p].gradient);
        add_scaled(slopes[p].mixed, weighted, r.by_b);
        for (std::size_t q = 0; q <= p; ++q)
          slopes[p].with[q] = hn::MulAdd(weighted, slope[q], slopes[p].with[q]);
      }
    }
    const Factor f = factor_of(d_, point.matrix);
    const M is_pixel = hn::FirstN(d_, pixels - at_);
    const auto sum = [&](V v) {
      return double{hn::GetLane(hn::SumOfLanes(d_, hn::IfThenElseZero(is_pixel, v)))};
    };
    for (std::size_t p = 0; p < nudged.size(); ++p) {
      const Vector3 solved = solved_by(f, slopes[p].mixed);
      const std::size_t row = nudged[p].parameter;
      sums.gradient[row] += sum(hn::Sub(slopes[p].gradient, dot(solved, point.gradient)));
      for (std::size_t q = 0; q <= p; ++q) {
        const double both = sum(hn::Sub(slopes[p].with[q], dot(solved, slopes[q].mixed)));
        const std::size_t column = nudged[q].parameter;
        sums.matrix[row][column] += both;
        if (q < p) sums.matrix[column][row] += both;
      }
    }
  }

 private:
  using Lanes = LobeLanes<kFamily>;
  // What the readings of a vector of pixels say of one shared value.
  struct Shared {
    V gradient;
    Vector3 mixed;            // with b
    V with[kLobeParameters];  // with the values up to it
  };
  // b, with what its readings share.
  struct Place {
    Vector3 b;
    V rho, inverse_rho;
    Frame frame;
    typename Lanes::Seen seen;
  };
  // What the readings say there.
  struct Point {
    Vector3 b;
    V rho;
    Frame frame;
    V cost, square;  // of residuals
    Symmetric matrix;
    Vector3 gradient;
  };
  // A fit under way.
  struct Walk {
    Yarn yarn;
    Point at;
    Vector3 step;
    V wins;      // what the step should win, were the readings linear
    V failures;  // of this step
    V left;      // steps that may still be taken
    M active;
  };

  static HWY_INLINE V f0_lanes(D d, const Lobe& lobe, const LobeBlock& block, std::size_t at) {
    V f0 = number(d, lobe.f0);
    if (!lobe.is_tinted()) return f0;
    const V channel = hn::LoadU(d, block.channel.data() + at);
    for (int c = 0; c < 3; ++c)
      f0 = hn::IfThenElse(hn::Eq(channel, number(d, c + 1)), number(d, f0_of(lobe, c)), f0);
    return f0;
  }
  HWY_INLINE Vector3 load(const LobeBlock::Lanes3& v) const {
    return {hn::LoadU(d_, v.x.data() + at_), hn::LoadU(d_, v.y.data() + at_),
            hn::LoadU(d_, v.z.data() + at_)};
  }
  HWY_INLINE void store(V v, LobeBlock::Lane& into) const { hn::StoreU(v, d_, into.data() + at_); }
  HWY_INLINE void store(M where, V v, LobeBlock::Lane& into) const {
    store(blended(where, v, hn::LoadU(d_, into.data() + at_)), into);
  }

  HWY_INLINE Yarn yarn_of(M across) const {
    return {blended(across, number(d_, -sine_), number(d_, cosine_)),
            blended(across, number(d_, cosine_), number(d_, sine_))};
  }

  HWY_INLINE Place place_of(Vector3 b, const Yarn& yarn) const {
    Place p;
    p.b = b;
    p.rho = hn::Max(hn::Sqrt(dot(b, b)), number(d_, 1e-12));
    p.inverse_rho = hn::Div(number(d_, 1), p.rho);
    p.frame = frame_of(d_, scaled(b, p.inverse_rho), yarn.x, yarn.y);
    p.seen = lobe_.seen(p.frame, view_);
    return p;
  }

  // One reading at a place, with the derivative of its model by b in the frame.
  struct Linear {
    V model, residual, weight;  // Huber's weight
    V cost;
    M is_used;
    Vector3 by_b;
  };
  HWY_INLINE Linear linear(const LobeBlock::Light& light, const Place& p) const {
    const V zero = hn::Zero(d_), one = number(d_, 1);
    const Toward to = toward(p.frame, load(light.to_light));
    V beneath = one;
    typename Lanes::Shine shine = {zero, zero, zero};
    if constexpr (kFamily != LobeFamily::kLambert) {
      const V grazing = hn::LoadU(d_, light.grazing.data() + at_);
      const V fresnel = hn::MulAdd(hn::Sub(one, f0_), grazing, f0_);
      beneath = hn::Sub(one, fresnel);
      shine = lobe_.shine(p.frame, p.seen, to, toward(p.frame, load(light.half)),
                          hn::Mul(fresnel, hn::LoadU(d_, light.lobe_share.data() + at_)));
    }
    const V cosine = hn::Max(to.normal, zero), lit = hn::IfThenElseZero(hn::Gt(to.normal, zero), beneath);
    const V straight = hn::NegMulAdd(bend_, hn::Sub(one, cosine), one);
    const V by_turn = hn::Mul(lit, hn::MulAdd(bend_, cosine, straight));
    Linear r;
    r.by_b.x = hn::Mul(hn::Mul(lit, straight), cosine);
    r.by_b.y = hn::MulAdd(by_turn, to.along, hn::Mul(shine.by_along, p.inverse_rho));
    r.by_b.z = hn::MulAdd(by_turn, to.across, hn::Mul(shine.by_across, p.inverse_rho));
    r.model = hn::MulAdd(p.rho, r.by_b.x, shine.value);
    r.residual = hn::Sub(hn::LoadU(d_, light.reading.data() + at_), r.model);
    const V root_weight = hn::LoadU(d_, light.root_weight.data() + at_), huber = number(d_, kHuberSigmas);
    r.is_used = hn::Gt(root_weight, zero);
    const V size = hn::Mul(hn::Abs(r.residual), root_weight), inner = hn::Min(size, huber);
    // Half of the square up to Huber's limit, its tangent beyond.
    r.cost = hn::Mul(inner, hn::NegMulAdd(number(d_, 0.5), inner, size));
    r.weight = hn::Mul(square_of(root_weight), hn::Div(huber, hn::Max(size, huber)));
    return r;
  }

  Point point_at(Vector3 b, const Yarn& yarn) const {
    const Place place = place_of(b, yarn);
    const V zero = hn::Zero(d_);
    Point p = {b, place.rho, place.frame, zero, zero, zero_matrix(d_), zero_vector(d_)};
    for (const LobeBlock::Light& light : block_.lights()) {
      const Linear r = linear(light, place);
      p.cost = hn::Add(p.cost, r.cost);
      p.square = hn::Add(p.square, hn::IfThenElseZero(r.is_used, square_of(r.residual)));
      const Vector3 wj = scaled(r.by_b, r.weight);
      add_outer(p.matrix, wj, r.by_b);
      add_scaled(p.gradient, r.residual, wj);
    }
    // So that every pixel has a step.
    const V little = hn::MulAdd(number(d_, 1e-6), trace(p.matrix), number(d_, 1e-30));
    p.matrix.xx = hn::Add(p.matrix.xx, little);
    p.matrix.yy = hn::Add(p.matrix.yy, little);
    p.matrix.zz = hn::Add(p.matrix.zz, little);
    return p;
  }

  HWY_INLINE void take(M where, const Point& from, Point& into) const {
    into.b = blended(where, from.b, into.b);
    into.rho = blended(where, from.rho, into.rho);
    into.frame.normal = blended(where, from.frame.normal, into.frame.normal);
    into.frame.along = blended(where, from.frame.along, into.frame.along);
    into.frame.across = blended(where, from.frame.across, into.frame.across);
    into.cost = blended(where, from.cost, into.cost);
    into.square = blended(where, from.square, into.square);
    into.matrix = blended(where, from.matrix, into.matrix);
    into.gradient = blended(where, from.gradient, into.gradient);
  }

  Walk begin(const Yarn& yarn) const {
    const V zero = hn::Zero(d_);
    Walk w = {yarn,       point_at(load(block_.start), yarn), zero_vector(d_), zero, zero, hn::Inf(d_),
              no_lane(d_)};
    w.active = hn::Lt(w.at.cost, hn::Inf(d_));
    aim(w, w.active);
    return w;
  }

  // The next step of some lanes. Where it is the last it is taken at once.
  HWY_INLINE void aim(Walk& w, M where) const {
    const Point& p = w.at;
    const Vector3 step = solved_by(factor_of(d_, p.matrix), p.gradient);
    const V size = hn::Sqrt(dot(step, step)), most = hn::Mul(hn::Set(d_, kMostStep), p.rho);
    const V wins = hn::Mul(number(d_, 0.5), dot(p.gradient, step));
    const V shorter = blended(hn::Gt(size, most), hn::Div(most, size), number(d_, 1));
    const Vector3 in_frame = scaled(step, shorter);
    const Vector3 in_rig = moved(moved(scaled(p.frame.normal, in_frame.x), in_frame.y, p.frame.along),
                                 in_frame.z, p.frame.across);
    const M is_none = hn::AndNot(hn::Lt(size, hn::Inf(d_)), where);
    w.active = hn::AndNot(is_none, w.active);
    where = hn::AndNot(is_none, where);
    w.step = blended(where, in_rig, w.step);
    w.wins = blended(where, wins, w.wins);
    w.failures = hn::IfThenZeroElse(where, w.failures);
    M is_last = hn::Lt(wins, hn::MulAdd(hn::Set(d_, last_.share), p.cost, hn::Set(d_, last_.wins)));
    is_last = hn::And(is_last, hn::Lt(size, hn::Mul(hn::Set(d_, kLastStep), p.rho)));
    is_last = hn::And(is_last, where);
    w.at.b = moved(w.at.b, number(d_, 1), masked(is_last, in_rig));
    w.active = hn::AndNot(is_last, w.active);
  }

  // So many evaluations, of steps that are halved until the cost falls.
  void advance(Walk& w, int evaluations) const {
    const V one = number(d_, 1);
    for (int i = 0; i < evaluations && !hn::AllFalse(d_, w.active); ++i) {
      const Point trial = point_at(moved(w.at.b, one, w.step), w.yarn);
      const M better = hn::And(w.active, hn::Lt(trial.cost, w.at.cost));
      take(better, trial, w.at);
      w.failures = hn::Add(w.failures, one);
      w.active = hn::And(w.active, hn::Or(better, hn::Le(w.failures, number(d_, kMostHalvings))));
      w.left = hn::Sub(w.left, hn::IfThenElseZero(better, one));
      w.active = hn::And(w.active, hn::Gt(w.left, hn::Zero(d_)));
      w.step = scaled(w.step, number(d_, 0.5));
      aim(w, hn::And(better, w.active));
    }
  }

  HWY_INLINE void give_up(Walk& w, V cost_of_others) const {
    const V least = hn::NegMulAdd(hn::Set(d_, kHope), w.wins, w.at.cost);
    w.active = hn::AndNot(hn::Gt(least, cost_of_others), w.active);
  }

  void write(const Point& p, V best, V across, LobeBlock& block, std::size_t index) const {
    const M better = hn::Lt(p.cost, best);
    store(better, p.b.x, block.solved.x);
    store(better, p.b.y, block.solved.y);
    store(better, p.b.z, block.solved.z);
    store(better, p.cost, block.cost);
    store(better, across, block.across);
    store(better, number(d_, static_cast<double>(index)), block.lobe);
    const V used = hn::Max(hn::LoadU(d_, block.used.data() + at_), number(d_, 1));
    store(better, hn::Sqrt(hn::Div(p.square, used)), block.residual);
    const Symmetric& m = p.matrix;
    const V elements[] = {m.xx, m.xy, m.xz, m.yy, m.yz, m.zz};
    for (std::size_t i = 0; i < 6; ++i) store(better, elements[i], block.normal_matrix[i]);
  }

  D d_;
  Last last_;
  Lanes lobe_;
  V bend_, f0_;
  double cosine_, sine_;  // of the lobe's axis
  const LobeBlock& block_;
  std::size_t at_;
  Vector3 view_;
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
    case LobeFamily::kTwoGgx:
      return work.template operator()<LobeFamily::kTwoGgx>();
  }
}

void fit_block_lanes(const Lobe& lobe, LobeBlock& block, int steps) {
  const D d;
  for_family(lobe.family, [&]<LobeFamily kFamily>() {
    for (std::size_t at = 0; at < LobeBlock::kPixels; at += hn::Lanes(d))
      LanesFit<kFamily>(d, lobe, block, at, kToRounding).fit(block, steps);
  });
}

void improve_block_lanes(const Lobe& lobe, std::size_t index, LobeBlock& block, std::size_t pixels) {
  const D d;
  for_family(lobe.family, [&]<LobeFamily kFamily>() {
    for (std::size_t at = 0; at < pixels; at += hn::Lanes(d))
      LanesFit<kFamily>(d, lobe, block, at).improve(block, index);
  });
}

void write_variances_lanes(const Lobe& lobe, std::span<const Lobe> one_sigma_off, const LobeBlock& block,
                           std::size_t pixels, BlockVariances& variances) {
  const D d;
  for_family(lobe.family, [&]<LobeFamily kFamily>() {
    for (std::size_t at = 0; at < pixels; at += hn::Lanes(d))
      LanesFit<kFamily>(d, lobe, block, at).write_variances(one_sigma_off, variances);
  });
}

void add_shared_lanes(const Lobe& lobe, std::span<const NudgedLobe> nudged, const LobeBlock& block,
                      std::size_t pixels, SharedEquations& sums) {
  const D d;
  for_family(lobe.family, [&]<LobeFamily kFamily>() {
    for (std::size_t at = 0; at < pixels; at += hn::Lanes(d))
      LanesFit<kFamily>(d, lobe, block, at).add_shared(nudged, pixels, sums);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace weft::solver {

HWY_EXPORT(fit_block_lanes);
HWY_EXPORT(improve_block_lanes);
HWY_EXPORT(write_variances_lanes);
HWY_EXPORT(add_shared_lanes);

void fit_block(const Lobe& lobe, LobeBlock& block, int steps) {
  HWY_DYNAMIC_DISPATCH(fit_block_lanes)(lobe, block, steps);
}

void improve_block(const Lobe& lobe, std::size_t index, LobeBlock& block, std::size_t pixels) {
  HWY_DYNAMIC_DISPATCH(improve_block_lanes)(lobe, index, block, pixels);
}

void write_variances(const Lobe& lobe, std::span<const Lobe> one_sigma_off, const LobeBlock& block,
                     std::size_t pixels, BlockVariances& variances) {
  HWY_DYNAMIC_DISPATCH(write_variances_lanes)(lobe, one_sigma_off, block, pixels, variances);
}

void add_shared(const Lobe& lobe, std::span<const NudgedLobe> nudged, const LobeBlock& block,
                std::size_t pixels, SharedEquations& sums) {
  HWY_DYNAMIC_DISPATCH(add_shared_lanes)(lobe, nudged, block, pixels, sums);
}

namespace {

void write_lanes(LobeBlock::Lanes3& into, std::size_t pixel, Vec3 v) {
  into.x[pixel] = static_cast<float>(v.x);
  into.y[pixel] = static_cast<float>(v.y);
  into.z[pixel] = static_cast<float>(v.z);
}

Vec3 read_lanes(const LobeBlock::Lanes3& from, std::size_t pixel) {
  return {from.x[pixel], from.y[pixel], from.z[pixel]};
}

}  // namespace

void LobeBlock::put(std::size_t pixel, std::span<const LobeReading> readings) {
  for (std::size_t k = 0; k < lights_.size(); ++k) {
    const LobeReading& r = readings[k];
    Light& light = lights_[k];
    write_lanes(light.to_light, pixel, r.from.light);
    write_lanes(light.half, pixel, r.from.half);
    light.lobe_share[pixel] = static_cast<float>(r.from.lobe_share);
    light.grazing[pixel] = static_cast<float>(std::pow(1 - r.from.light_half, 5));
    light.root_weight[pixel] = static_cast<float>(std::sqrt(r.weight));
    light.reading[pixel] = r.weight > 0 ? static_cast<float>(r.x) : 0.0F;
  }
  used[pixel] = static_cast<float>(used_of(readings));
  write_lanes(view, pixel, readings.front().from.view);
  channel[pixel] = static_cast<float>(readings.front().from.channel + 1);
  cost[pixel] = std::numeric_limits<float>::infinity();
}

void LobeBlock::begin_at(std::size_t pixel, Vec3 b) {
  write_lanes(start, pixel, b);
}

void LobeBlock::copy(std::size_t pixel, const LobeBlock& other, std::size_t other_pixel) {
  const auto lane = [&](Lane& into, const Lane& from) { into[pixel] = from[other_pixel]; };
  const auto lanes = [&](Lanes3& into, const Lanes3& from) {
    lane(into.x, from.x);
    lane(into.y, from.y);
    lane(into.z, from.z);
  };
  for (std::size_t k = 0; k < lights_.size(); ++k) {
    Light& into = lights_[k];
    const Light& from = other.lights_[k];
    lanes(into.to_light, from.to_light);
    lanes(into.half, from.half);
    lane(into.grazing, from.grazing);
    lane(into.reading, from.reading);
    lane(into.root_weight, from.root_weight);
    lane(into.lobe_share, from.lobe_share);
  }
  lanes(view, other.view);
  lanes(start, other.start);
  lanes(solved, other.solved);
  for (const auto member : {&LobeBlock::channel, &LobeBlock::used, &LobeBlock::cost, &LobeBlock::lobe,
                            &LobeBlock::across, &LobeBlock::residual})
    lane(this->*member, other.*member);
  for (std::size_t i = 0; i < normal_matrix.size(); ++i) lane(normal_matrix[i], other.normal_matrix[i]);
}

void LobeBlock::leave_out(std::size_t pixel) {
  for (Light& light : lights_) light.root_weight[pixel] = 0;
  used[pixel] = 0;
}

void LobeBlock::reset() {
  cost.fill(std::numeric_limits<float>::infinity());
}

LobeReading LobeBlock::reading(std::size_t pixel, std::size_t light) const {
  const Light& of = lights_[light];
  LobeReading r;
  r.from.light = read_lanes(of.to_light, pixel);
  r.from.view = read_lanes(view, pixel);
  r.from.half = read_lanes(of.half, pixel);
  r.from.light_half = dot(r.from.light, r.from.half);
  r.from.lobe_share = of.lobe_share[pixel];
  r.from.channel = static_cast<int>(channel[pixel]) - 1;
  r.x = of.reading[pixel];
  r.weight = double{of.root_weight[pixel]} * of.root_weight[pixel];
  return r;
}

}  // namespace weft::solver
#endif
