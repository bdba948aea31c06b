// SPDX-License-Identifier: Apache-2.0
#include "material/maps/specular_occlusion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/base/vec.h"

namespace weft::material {
namespace {

constexpr int kCones = SpecularOcclusion::kCones;
using Cones = std::array<double, kCones>;

/// Directions of a lobe about the mirror direction, each of the same weight.
struct LobeRing {
  double cosine, sine;  ///< to the mirror direction
};

// Equal shares of the facets of GGX, whose half angle t has tan^2 t = alpha^2 u / (1 - u): light leaves at
// twice the angle.
std::vector<LobeRing> rings_of(double alpha) {
  constexpr int kRings = 256;
  std::vector<LobeRing> rings;
  for (int i = 0; i < kRings; ++i) {
    const double u = (i + 0.5) / kRings, angle = 2 * std::atan(alpha * std::sqrt(u / (1 - u)));
    if (angle < kPi / 2) rings.push_back({std::cos(angle), std::sin(angle)});
  }
  return rings;
}

// The lobe's share within each cone about the bent normal.
Cones shares_in_cones(const std::vector<LobeRing>& rings, double bent_to_mirror) {
  constexpr int kTurns = 128;
  constexpr double kStep = kPi / 2 / (kCones - 1);
  Cones shares = {};
  for (const LobeRing& ring : rings) {
    for (int k = 0; k < kTurns; ++k) {
      const double turn = kPi * (k + 0.5) / kTurns;  // the other half mirrors it
      const double cosine =
          ring.cosine * std::cos(bent_to_mirror) + ring.sine * std::sin(bent_to_mirror) * std::cos(turn);
      const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
      const int edge = static_cast<int>(std::ceil(angle / kStep));  // of the least cone that holds it
      if (edge < kCones) shares[static_cast<std::size_t>(edge)] += 1;
    }
  }
  for (std::size_t c = 1; c < kCones; ++c) shares[c] += shares[c - 1];
  const double all = std::max(shares.back(), 1e-30);
  for (double& share : shares) share /= all;
  return shares;
}

/// A place between two nodes of `count` over a range.
struct Node {
  std::size_t first;
  double part;

  Node(double value, double range, int count) {
    const double place = std::clamp(value / range, 0.0, 1.0) * (count - 1);
    const int lower = std::min(static_cast<int>(place), count - 2);
    first = static_cast<std::size_t>(lower);
    part = place - lower;
  }
};

}  // namespace

SpecularOcclusion::SpecularOcclusion() {
  values_.reserve(std::size_t{kCones} * kRoughness * kAngles);
  for (int a = 0; a < kAngles; ++a) {
    for (int r = 0; r < kRoughness; ++r) {
      const double alpha = std::max(static_cast<double>(r) / (kRoughness - 1), kLeastAlpha);
      const Cones shares = shares_in_cones(rings_of(alpha), kPi / 2 * a / (kAngles - 1));
      for (const double share : shares) values_.push_back(static_cast<float>(share));
    }
  }
}

double SpecularOcclusion::at(double cone_angle_deg, double alpha, double bent_to_mirror_deg) const {
  const Node cone(cone_angle_deg, 90, kCones), rough(alpha, 1, kRoughness),
      angle(bent_to_mirror_deg, 90, kAngles);
  double sum = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const std::size_t c = corner & 1, r = corner >> 1 & 1, a = corner >> 2;
    const double weight = (c != 0 ? cone.part : 1 - cone.part) * (r != 0 ? rough.part : 1 - rough.part) *
                          (a != 0 ? angle.part : 1 - angle.part);
    const std::size_t at = ((angle.first + a) * kRoughness + rough.first + r) * kCones + cone.first + c;
    sum += weight * static_cast<double>(values_[at]);
  }
  return sum;
}

}  // namespace weft::material
