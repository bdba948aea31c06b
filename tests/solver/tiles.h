// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "bench/oracles/oracle_rig.h"
#include "bench/oracles/quad_oracle.h"

// The tiles that the solver's tests solve.

namespace weft::test {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

inline constexpr Size kClothSize = {640, 480};
inline constexpr Rect kClothTile = {64, 33, 64 + 131, 33 + 16};

inline LightField cloth_field(const NearLights& lights) {
  return *LightField::make(lights, overhead_camera(kClothSize, 600, 0.3), kClothSize, 2);
}

/// Pixels of all kinds: normals up to `most_deg`, albedo from 0.02 to 0.92.
inline std::function<Truth(int, int)> cloth(double most_deg) {
  return [most_deg](int x, int y) {
    Random random(static_cast<std::uint64_t>(y) * 1000 + static_cast<std::uint64_t>(x));
    const Vec3 n = random_normal(random, most_deg);
    return Truth{
        n, {0.02 + 0.9 * random.uniform(), 0.02 + 0.9 * random.uniform(), 0.02 + 0.9 * random.uniform()}};
  };
}

/// The strip of every hard case of docs/numerics.md.
inline constexpr Size kHardSize = {256, 16};
inline constexpr Rect kHardTile = {0, 0, 131, 2};

inline LightField hard_field(DistantLights lights) {
  return *LightField::make(std::move(lights), std::nullopt, kHardSize, 0);
}
inline LightField hard_field(const NearLights& lights) {
  return *LightField::make(lights, overhead_camera(kHardSize, 600, 0.3), kHardSize, 0);
}

/// The slow truth of one pixel of a tile.
inline OracleSolution oracle_of(const Trial& trial, int planes, int x, int y) {
  return solve_in_quad(oracle_rows(trial.rows(x, y), planes));
}

}  // namespace weft::test
