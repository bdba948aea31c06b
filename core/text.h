// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace weft {

/// Insertions, deletions and substitutions of bytes from one word to the other (Levenshtein 1966): the
/// nearest known name is the one to suggest for an unknown one.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// "2026-11-21T14:25:01.250Z", of seconds since 1970.
std::string iso_time(double since_1970_s);

/// As text or as the value of an attribute in HTML and SVG.
std::string escape_markup(std::string_view text);

}  // namespace weft
