// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/base/vec.h"
#include "core/rig/camera.h"

namespace weft::solve {

/// Turns directions of the rig frame into the axes of the picture: x along its columns, y up its rows, z up
/// from the table. A turn about z alone, since heights are those above the table: a camera that leans by two
/// degrees changes distances in the picture by less than their thousandth. Without a camera the light
/// directions are given by these axes, and nothing turns.
Mat3 picture_from_rig(const std::optional<CameraModel>& camera);

}  // namespace weft::solve
