// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/cli/verb.h"

namespace weft::app {

/// Verbs that run in `weft` itself, since they load neither OpenCV nor readers of images. A verb of verbs may
/// be here with some of them empty (a name and a help alone): weft-work runs those.
std::vector<Verb> light_verbs();

}  // namespace weft::app
