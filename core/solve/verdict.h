// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/describe/fields.h"

namespace weft {

/// What a document says of a work to the person who did it, and what to do about it.
struct Verdict {
  std::string name;    ///< for programs: LED_DEAD, WEAK_COVERAGE
  std::string text;    ///< one sentence with its numbers, without a full stop
  std::string remedy;  ///< an imperative phrase without a full stop; may be empty

  friend bool operator==(const Verdict&, const Verdict&) = default;
};

void describe(Fields& fields, Verdict& verdict);

/// Whether it says that a frame or the dark shot lies: FRAME_FITS_NOTHING, DARK_SHOT and their like.
bool is_of_frames(const Verdict& verdict);

/// A list of {"name", "text", "remedy"}.
Json json_of(const std::vector<Verdict>& verdicts);

}  // namespace weft
