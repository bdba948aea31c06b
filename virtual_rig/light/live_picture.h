// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "virtual_rig/light/exposed_frame.h"

namespace weft::virtual_rig {

/// What a body's finder shows of this light: the frame at 640 pixels at most, as JPEG of quality 85, in the
/// camera's channels made grey on average. As a body does, it chooses its own brightness: the middle of the
/// picture comes out grey whatever the light, up to the noise that little light brings. Single cells of
/// filters are read in even steps, so that fine yarn aliases as it does in a real one.
std::vector<std::uint8_t> live_picture(const LightFrames& frames, const GatheredLight& light);

}  // namespace weft::virtual_rig
