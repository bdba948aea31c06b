// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>

#include "core/base/result.h"
#include "core/rig/lights.h"

namespace weft::solve {

/// What is done to directions of lights that mean other axes than x right, y up, z to the camera.
enum class LightFlip { kNone, kX, kY, kZ, kAll, kLeft, kRight, kExchange, kAgainst };
inline constexpr std::array<const char*, 9> kLightFlipNames = {"none", "x",     "y",        "z",      "all",
                                                               "left", "right", "exchange", "against"};

/// Turns lights as asked for. kBadData, naming `source`, where one then lies clearly below the table.
Result<void> lay_lights(LightFlip flip, const std::filesystem::path& source, DistantLights& lights);

}  // namespace weft::solve
