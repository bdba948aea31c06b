// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/cli/verb.h"

namespace weft::app {

/// `weft rig flash`.
Run add_rig_flash(Options& options);

/// The LED board's firmware as Intel HEX.
const char* carried_firmware();

}  // namespace weft::app
