// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/rig/albedo_scale.h"

// Whether what the reference level can do to a cloth can gain anything, measured on tiles of it before it is
// done.

namespace weft::solver {

/// One sample tile (sample_tiles.h) after a first solve; planes have (0, 0) at the tile's corner.
struct SolvedSample {
  std::array<View<const float>, 3> normal;
  View<const float> albedo;  ///< of each photosite, or any one channel
  View<const std::uint16_t> status;
  std::int64_t readings = 0;  ///< usable readings
  std::int64_t shadowed = 0;  ///< usable readings below kShadowShare of the bright ones of their pixel
};

/// A measured quantity and what follows from it.
struct Gate {
  std::string name;
  double value = 0;
  double limit = 0;
  std::string unit;
  bool is_over = false;  ///< value > limit
};

struct GateLimits {
  double slope_deg = 20;          ///< 95th percentile over the pixels
  double shadowed_share = 0.01;   ///< of the readings
  double indirect_share = 0.005;  ///< mean albedo times 1 minus mean openness: what bounces add to the light
  double specular_share = 0.2;    ///< of the pixels: beyond, a Lambertian cloth cannot be assumed
};

/// What was measured, against each of the GateLimits. Openness comes from the height of each tile alone, by a
/// horizon scan of 4 slices of 8 steps.
struct Gates {
  Gate slope, shadowed, indirect, specular;

  std::array<Gate, 4> measured() const { return {slope, shadowed, indirect, specular}; }
  /// Cast shadows are worth tracing: slopes or dark readings call for it, and the cloth is not specular.
  bool shadows() const { return (slope.is_over || shadowed.is_over) && !specular.is_over; }
  bool interreflection() const { return indirect.is_over && !specular.is_over; }
};

/// Normals are by the axes of the picture. An albedo whose scale is relative is taken for 1, the most that
/// it can be. Errors: as height_from_normals and scan_openness; kBadData without samples.
Result<Gates> measure_gates(std::span<const SolvedSample> samples, const GateLimits& limits,
                            AlbedoScale scale);

}  // namespace weft::solver
