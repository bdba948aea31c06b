// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/json_document.h"

namespace weft::report {

/// What a report says of a work to the person who did it, and what to do about it.
struct Verdict {
  std::string name;    ///< for programs: LED_DEAD, WEAK_COVERAGE
  std::string text;    ///< one sentence with its numbers, without a full stop
  std::string remedy;  ///< an imperative phrase without a full stop; may be empty
};

/// A list of {"name", "text", "remedy"}.
Json json_of(const std::vector<Verdict>& verdicts);

}  // namespace weft::report
