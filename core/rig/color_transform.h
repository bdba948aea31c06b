// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/image/color_spaces.h"
#include "core/rig/calibration.h"

// What a calibration makes of a camera's colours.

namespace weft {

/// A map of ColorCurve: 3 x 4 by rows.
Xyy affine_of(const std::array<double, 12>& map, const Xyy& color);
/// A map of ColorCurve: four numbers a channel.
Xyy cubic_of(const std::array<double, 12>& map, const Xyy& color);

/// Linear Rec.709 of a camera colour: by the curve where there is one, else by the matrix. Channels below 0
/// stay.
Rgb rec709_of_camera(const ColorTransform& transform, const Rgb& camera);

}  // namespace weft
