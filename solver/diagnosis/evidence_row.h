// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/vec.h"
#include "core/rig/radiometry.h"

namespace weft::solver {

/// One pixel in the photograph of one light: the light's direction l (unit, rig frame) and strength e there,
/// and the reading r (+infinity saturated, NaN missing, -infinity known to be in shadow). The model is
/// r = rho e max(0, n . l).
struct EvidenceRow {
  Vec3 direction;
  double strength = 0;
  double reading = 0;
};

/// Pixels taken from all over the frame, with all lights of each: what a diagnosis reads.
struct Evidence {
  std::size_t lights = 0;
  std::vector<EvidenceRow> rows;                ///< [pixel * lights + light]
  std::vector<std::array<double, 2>> position;  ///< of each pixel: -1 to 1, left to right and top to bottom
  std::vector<int> channel = {};                ///< of each pixel: 0 to 2, or any one where all are alike
  std::optional<NoiseModel> noise;              ///< of the readings, where it is known

  std::size_t pixels() const { return position.size(); }
  const EvidenceRow& at(std::size_t pixel, std::size_t light) const { return rows[pixel * lights + light]; }
};

}  // namespace weft::solver
