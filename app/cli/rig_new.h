// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/cli/verb.h"

namespace weft::app {

/// Options of `weft rig new`, which looks at what is plugged in and writes a rig file that names it.
Run add_rig_new(Options& options);

}  // namespace weft::app
