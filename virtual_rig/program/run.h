// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "virtual_rig/virtual_rig.h"

namespace weft::virtual_rig {

/// Starts a rig, says READY with how to use it on standard output, and keeps it until SIGINT, SIGTERM, "end"
/// on its control socket or the end of the process that started this one; with a command, until that ends,
/// which then gives the exit code (128 + the signal that killed it). Progress goes to standard error.
/// `ready`: the descriptor of a rig in the background (background.h), else -1.
Result<int> run_virtual_rig(const VirtualRigOptions& options, const std::vector<std::string>& command,
                            int ready);

}  // namespace weft::virtual_rig
