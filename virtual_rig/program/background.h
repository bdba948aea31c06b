// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace weft::virtual_rig {

/// Runs this program again in a session of its own, with these arguments and `--ready FD`, and returns once
/// it has called detach() or ended, with an exit code: 0, or its own. It is no plain fork: libraries that
/// started threads before main() would wait for them at the end.
int run_in_background(const std::vector<std::string>& arguments);

/// In that program: lets the one that started it go; from now on all three standard streams are the null
/// device. `ready` below 0: it is not in the background, and nothing happens.
void detach(int ready);

}  // namespace weft::virtual_rig
