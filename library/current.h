// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/session.h"
#include "core/solve.h"

// The solve of a session that others are made from.

namespace weft::library {

/// Its id: the one that `current_solve` of session.json names, else the oldest; empty where there is none. So
/// a further solve never becomes it by itself; change_metadata() moves it.
std::string current_solve(const Session& session);

}  // namespace weft::library
