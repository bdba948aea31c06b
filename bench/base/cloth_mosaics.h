// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/photographs.h"

namespace weft::bench {

enum class Cloth {
  kSmooth,  ///< Lambert's law
  kSatin    ///< and a highlight of the half vector, exponent 24, as strong as half the diffuse albedo
};

/// Puts cloth of albedo 0.4 before the lights of grey mosaics (bench/base/yardsticks.h), with photon and read
/// noise: a weave of 24 pixels a period whose slopes reach 12 degrees, seen from above. Counts are a function
/// of the pixel alone.
void put_cloth(pipeline::Photographs& photographs, Cloth cloth, int threads);

}  // namespace weft::bench
