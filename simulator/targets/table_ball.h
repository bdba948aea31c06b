// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "simulator/targets/target.h"

// A ball on the table, by which lamps are told.

namespace weft::simulator {

enum class BallSurface {
  kMatt,    ///< Lambert
  kGlossy,  ///< Lambert under glass of f0 = 0.04
  kChrome   ///< mirrors 0.6
};

struct BallSettings {
  BallSurface surface = BallSurface::kChrome;
  Vec3 centre_mm;            ///< rig frame; -10000 to 10000
  double radius_mm = 10;     ///< 0.1 to 1000
  double albedo = 0.02;      ///< of what does not mirror; 0.001 to 1
  double highlight_deg = 1;  ///< standard deviation of a mirrored lamp's brightness; 0.1 to 10

  bool operator==(const BallSettings&) const = default;
};

/// Where a ray meets a ball.
struct BallHit {
  Vec3 point_mm, normal;
  double coverage = 1;  ///< share of the pixel
};

/// Nothing for a pixel that the ball does not reach into.
std::optional<BallHit> hit(const BallSettings& ball, const ViewRay& ray);

/// What a ball mirrors of a lamp in this direction over what white paper that faces the lamp reflects, mean
/// over a grid of 8 x 8 rays of the pixel. 0 for a matt ball.
double mirrored(const BallSettings& ball, const ViewRay& ray, Vec3 to_light);

}  // namespace weft::simulator
