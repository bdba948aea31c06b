// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace weft::simulator {

/// Linear Rec.709 red, green, blue; or what the camera's red, green and blue filters pass.
using Rgb = std::array<double, 3>;

}  // namespace weft::simulator
