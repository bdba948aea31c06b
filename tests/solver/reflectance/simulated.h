// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulator/reflectance/reflectance.h"
#include "tests/solver/reflectance/pixels.h"

namespace weft::solver {

/// What the simulator reflects of light and view in the frame of the normal.
inline PixelModel simulated(const simulator::Reflectance& model) {
  return [model](Vec3 n, double albedo, double, const LitFrom& from) {
    const Vec3 x = normalized(Vec3{1, 0, 0} - n.x * n), y = cross(n, x);
    const auto local = [&](Vec3 d) { return Vec3{dot(d, x), dot(d, y), dot(d, n)}; };
    const double cosine = dot(n, from.light);
    if (!(cosine > 0)) return 0.0;
    return kPi * cosine *
           simulator::evaluate(model, {albedo, albedo, albedo}, local(from.light), local(from.view))[1];
  };
}

}  // namespace weft::solver
