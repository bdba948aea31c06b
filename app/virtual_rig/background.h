// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

namespace weft::app {

/// Goes on in a child of its own session. In the caller's process it returns, once the child has called
/// detach() or ended, with an exit code: 0, or the child's. In the child it returns nothing.
/// Call it while there is one thread.
std::optional<int> into_background();

/// In the child: lets the caller go; from now on all three standard streams are the null device. Elsewhere it
/// does nothing and returns false.
bool detach();

}  // namespace weft::app
