// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/base/result.h"
#include "core/rig/lights.h"
#include "core/rig/photo_reading.h"

namespace weft::solve {

/// Turns lights as asked for. kBadData, naming `source`, where one then lies clearly below the table.
Result<void> lay_lights(LightFlip flip, const std::filesystem::path& source, DistantLights& lights);

}  // namespace weft::solve
