// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench/accuracy/contenders.h"
#include "bench/accuracy/scenes.h"
#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

/// The patches of a scene with the Cramer-Rao bound of each pixel: rms degrees for the lights that the point
/// faces and sees.
struct BoundedPatches {
  std::vector<Patch> patches;
  std::vector<Image<float>> bounds;
};
BoundedPatches with_bounds(std::vector<Patch> patches, int threads);

/// Errors and time of one contender on the patches of one scene, as accuracy_table() describes them, without
/// what compares it with others.
Result<Json> score(const Contender& contender, const BoundedPatches& scene, int threads);

/// The mean of rows that belong together: of every number that is no integer.
Json mean_row(const std::vector<const Json*>& rows);

double number(const Json& row, const char* key);

}  // namespace weft::bench
