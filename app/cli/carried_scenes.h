// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace weft::app {

// Scenes that the program carries, by their name in testdata/scenes/.
const char* demo_scene();
const char* sample_scene();
const char* torture_scene();

}  // namespace weft::app
