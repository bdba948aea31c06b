// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulator/effects/passes.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_rig.h"

namespace weft::simulator {

/// What the programs that zero_cost_test counts render: a flat cloth under near light, 256 x 256 pixels.
Scene scene_of_the_frame();

/// Renders a frame once to warm up and once within weft_frame(), which callgrind counts, on one thread;
/// prints a digest of its counts. Returns the program's exit code.
int print_frame(PassList list);

}  // namespace weft::simulator
