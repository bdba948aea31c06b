// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/cli/options.h"
#include "app/cli/verb.h"

namespace weft::app {

/// `weft rig plan`
Run add_rig_plan(Options& options);

}  // namespace weft::app
