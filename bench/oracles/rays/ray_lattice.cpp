// SPDX-License-Identifier: Apache-2.0
#include "bench/oracles/rays/ray_lattice.h"

#include <cmath>
#include <utility>

#include "core/base/vec.h"

namespace weft::test {
namespace {

/// A vector of the lattice in steps of 1 / R.
struct Step {
  int u, v;
};

/// Squared length where the lattice lies as directions do: u is the squared radius in a disc and v the turn,
/// so that at the radius with half of the disc inside a step of v is 2 pi times one of u.
double squared(Step s) {
  return s.u * s.u + 4 * kPi * kPi * s.v * s.v;
}

double product(Step a, Step b) {
  return a.u * b.u + 4 * kPi * kPi * a.v * b.v;
}

/// The two shortest vectors that span the lattice, the shorter first (Gauss's reduction).
std::pair<Step, Step> reduced_basis(int points, int a) {
  Step shorter = {0, points}, longer = {1, a};
  while (squared(longer) < squared(shorter)) {
    std::swap(shorter, longer);
    const int times = static_cast<int>(std::lround(product(shorter, longer) / squared(shorter)));
    longer = {longer.u - times * shorter.u, longer.v - times * shorter.v};
  }
  return {shorter, longer};
}

}  // namespace

Lattice make_lattice(int points) {
  int best = 0;
  for (int a = 1; a < points; ++a) {
    if (squared(reduced_basis(points, a).first) > squared(reduced_basis(points, best).first)) best = a;
  }
  Lattice lattice;
  const auto scaled = [points](int u, int v) {
    return TorusPoint{static_cast<float>(u) / static_cast<float>(points),
                      static_cast<float>(v) / static_cast<float>(points)};
  };
  for (int i = 0; i < points; ++i) lattice.points.push_back(scaled(i, i * best % points));
  const auto [shorter, longer] = reduced_basis(points, best);
  lattice.cell = {scaled(shorter.u, shorter.v), scaled(longer.u, longer.v)};
  return lattice;
}

}  // namespace weft::test
