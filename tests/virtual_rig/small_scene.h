// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "simulator/scene/scene.h"

namespace weft::virtual_rig {

/// A noisy satin under three near LEDs, of `width` x 96 pixels.
simulator::Scene small_scene(int width = 128);

/// An empty folder of the running test's own.
std::filesystem::path fresh_folder();

}  // namespace weft::virtual_rig
