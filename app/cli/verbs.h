// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/cli/verb.h"

// Written from the lists of verbs in CMakeLists.txt.

namespace weft::app {

/// The verbs of weft-work, in the order of the help.
std::vector<Verb> work_verbs();

/// Those that run in `weft` itself, since they load neither OpenCV nor readers of images. A verb of verbs may
/// be here with some of them empty (a name and a help alone): weft-work runs those.
std::vector<Verb> light_verbs();

}  // namespace weft::app
