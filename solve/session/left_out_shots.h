// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/rig/session.h"

namespace weft::solve {

/// So many shots of a session a person may leave out.
inline constexpr std::size_t kMostLeftOut = 64;

/// The indices of the shots that a person left out of what is solved: `left_out` of session.json, which
/// change_metadata() sets. Entries that are no index are passed over.
std::vector<int> left_out(const Session& session);

}  // namespace weft::solve
