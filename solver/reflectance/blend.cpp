// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/blend.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace weft::solver {
namespace {

// Steps from one start, and how often one that wins nothing is halved.
constexpr int kJointSteps = 8, kJointHalvings = 4;
// The longest step, of b over its length and of the share: farther off the slopes say nothing.
constexpr double kMostTurn = 0.3, kMostShareStep = 0.3;
// A step that wins less of the cost is the last.
constexpr double kJointSettled = 1e-4;

double huber_cost(double residual, double weight) {
  const double size = std::abs(residual) * std::sqrt(weight);
  return size < kHuberSigmas ? 0.5 * size * size : kHuberSigmas * (size - 0.5 * kHuberSigmas);
}

double blend_cost(const Blend& blend, std::span<const LobeReading> readings, Vec3 b, double yarn) {
  double cost = 0;
  for (const LobeReading& r : readings) {
    if (r.weight > 0) cost += huber_cost(r.x - modelled(blend, b, r.from, yarn), r.weight);
  }
  return cost;
}

// The normal equations of b and of the share, which is eliminated last.
class JointSystem {
 public:
  JointSystem(const Blend& blend, std::span<const LobeReading> readings, Vec3 b, double yarn) {
    const double w = blend.second_share;
    for (const LobeReading& r : readings) {
      if (r.weight == 0) continue;
      const ModelledReading first = modelled_with_derivative(blend.first, b, r.from, yarn),
                            second = modelled_with_derivative(blend.second, b, r.from, yarn);
      const Vec3 by_b = (1 - w) * first.by_b + w * second.by_b;
      const double by_share = second.x - first.x, residual = r.x - (1 - w) * first.x - w * second.x;
      const double weight = r.weight * huber_weight(residual * std::sqrt(r.weight));
      of_b_.add(by_b, weight, residual);
      mixed_ = mixed_ + (weight * by_share) * by_b;
      of_share_ += weight * by_share * by_share;
      share_gradient_ += weight * by_share * residual;
    }
    of_b_.regularise();
    taken_ = of_b_.solved(mixed_);
    left_ = std::max(of_share_ - dot(mixed_, taken_), 1e-9 * of_share_ + 1e-30);
  }

  // Solves for both, to a right side of b and one of the share.
  Vec3 solved(Vec3 right, double right_share, double& share) const {
    const Vec3 alone = of_b_.solved(right);
    share = (right_share - dot(mixed_, alone)) / left_;
    return alone - share * taken_;
  }
  Vec3 step(double& share) const { return solved(of_b_.gradient, share_gradient_, share); }

 private:
  PixelSystem of_b_;
  Vec3 mixed_ = {0, 0, 0}, taken_ = {0, 0, 0};
  double of_share_ = 0, share_gradient_ = 0, left_ = 0;
};

struct Joint {
  Vec3 b;
  double share, cost;
};

// Halved until the cost falls; whether it did.
bool take_step(Blend blend, std::span<const LobeReading> readings, double yarn, Vec3 step, double share_step,
               Joint& at) {
  for (int halved = 0; halved <= kJointHalvings; ++halved, step = 0.5 * step, share_step *= 0.5) {
    const Vec3 b = at.b + step;
    blend.second_share = std::clamp(at.share + share_step, 0.0, 1.0);
    const double cost = blend_cost(blend, readings, b, yarn);
    if (!(cost < at.cost)) continue;
    at = {b, blend.second_share, cost};
    return true;
  }
  return false;
}

Joint joint_fit(Blend blend, std::span<const LobeReading> readings, Vec3 start, double yarn) {
  Joint at = {start, blend.second_share, blend_cost(blend, readings, start, yarn)};
  for (int i = 0; i < kJointSteps; ++i) {
    blend.second_share = at.share;
    double share_step = 0;
    Vec3 step = JointSystem(blend, readings, at.b, yarn).step(share_step);
    const double size = length(step), most = kMostTurn * length(at.b);
    if (!std::isfinite(size + share_step)) break;
    if (size > most) step = (most / size) * step;
    share_step = std::clamp(share_step, -kMostShareStep, kMostShareStep);
    const double before = at.cost;
    if (!take_step(blend, readings, yarn, step, share_step, at)) break;
    if (before - at.cost < kJointSettled * before) break;
  }
  return at;
}

}  // namespace

double specular(const Blend& blend, Vec3 normal, const LitFrom& from, double yarn) {
  const double first = blend.second_share < 1 ? specular(blend.first, normal, from, yarn) : 0,
               second = blend.second_share > 0 ? specular(blend.second, normal, from, yarn) : 0;
  return (1 - blend.second_share) * first + blend.second_share * second;
}

double modelled(const Blend& blend, Vec3 b, const LitFrom& from, double yarn) {
  const double first = blend.second_share < 1 ? modelled(blend.first, b, from, yarn) : 0,
               second = blend.second_share > 0 ? modelled(blend.second, b, from, yarn) : 0;
  return (1 - blend.second_share) * first + blend.second_share * second;
}

std::optional<double> albedo_beneath(const Blend& blend, std::span<const LobeReading> readings, Vec3 normal,
                                     double yarn) {
  double of_readings = 0, of_all = 0;
  for (const LobeReading& r : readings) {
    if (r.weight == 0) continue;
    const double shine = std::max(0.0, dot(normal, r.from.light)) * specular(blend, normal, r.from, yarn);
    const double diffuse = modelled(blend, normal, r.from, yarn) - shine;
    of_readings += r.weight * diffuse * (r.x - shine);
    of_all += r.weight * diffuse * diffuse;
  }
  if (!(of_all > 0)) return {};
  return of_readings / of_all;
}

BlendFit fit_blend(const Lobe& first, const Lobe& second, std::span<const LobeReading> readings, Vec3 start,
                   double yarn) {
  const Joint joint = joint_fit({first, second, 0.5}, readings, start, yarn);
  const auto parts = static_cast<unsigned>(std::lround(kBlendParts * joint.share));
  return {joint.share, parts, {joint.b, joint.cost}};
}

BlendVariances variances_of(const Blend& blend, std::span<const Lobe> first_off,
                            std::span<const Lobe> second_off, std::span<const LobeReading> readings, Vec3 b,
                            double yarn) {
  const JointSystem system(blend, readings, b, yarn);
  const Vec3 n = normalized(b);
  const std::array<Vec3, 3> axes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  BlendVariances v;
  double trace = 0, share = 0;
  for (const Vec3& axis : axes) {
    const Vec3 column = system.solved(axis, 0, share);
    trace += dot(column, axis);
    v.along_of_readings += dot(n, axis) * dot(column, n);
  }
  v.across_of_readings = trace - v.along_of_readings;
  const auto add = [&](const Lobe& lobe, std::span<const Lobe> others, double weight_of_lobe) {
    for (const Lobe& off : others) {
      Vec3 pull = {0, 0, 0};
      double share_pull = 0;
      for (const LobeReading& r : readings) {
        if (r.weight == 0) continue;
        const ModelledReading first = modelled_with_derivative(blend.first, b, r.from, yarn),
                              second = modelled_with_derivative(blend.second, b, r.from, yarn);
        const double w = blend.second_share, x = (1 - w) * first.x + w * second.x;
        const double weight = r.weight * huber_weight((r.x - x) * std::sqrt(r.weight)) * weight_of_lobe *
                              (modelled(off, b, r.from, yarn) - modelled(lobe, b, r.from, yarn));
        pull = pull + weight * ((1 - w) * first.by_b + w * second.by_b);
        share_pull += weight * (second.x - first.x);
      }
      const Vec3 change = system.solved(pull, share_pull, share);
      const double along = dot(change, n);
      v.along_of_lobes += along * along;
      v.across_of_lobes += dot(change, change) - along * along;
    }
  };
  add(blend.first, first_off, 1 - blend.second_share);
  add(blend.second, second_off, blend.second_share);
  return v;
}

}  // namespace weft::solver
