// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "solver/diagnosis/evidence_row.h"

namespace weft::solver {

/// The share of pixels with a reading over strength that is over kSpecularTimes what matt cloth of the frame
/// gives: the three-quarter quantile, among pixels of its channel, of the median over the lights. Highlights
/// outshine the cloth. Light that falls into a hole, where most lights are in shadow, is as much over its
/// pixel's prediction but no brighter than the cloth beside it.
double outshining_share(const Evidence& evidence);

/// Where fewer pixels have such a reading, what the bit SPECULAR marks is holes and crevices.
inline constexpr double kLeastOutshining = 0.05;

}  // namespace weft::solver
