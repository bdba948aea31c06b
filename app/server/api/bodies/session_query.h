// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "core/base/result.h"
#include "library/catalogue/catalogue.h"

namespace weft::app {

/// What sessions are asked for by the words of an address: query, id, tag, state, rig, calibration, from, to,
/// warned, limit and after. kUsage with the word and its rule.
Result<library::Query> session_query(const std::map<std::string, std::string>& asked);

}  // namespace weft::app
