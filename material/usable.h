// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/base/result.h"
#include "material/surface.h"

namespace weft::material {

/// kBadData, with `what` for its first words, unless a surface is at least `least_side` pixels wide and high,
/// has a scale above 0 and finite values in every map, and all its maps have one size.
Result<void> check_surface(const Surface& surface, int least_side, const std::string& what);

}  // namespace weft::material
