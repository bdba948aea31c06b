// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace weft {

/// Insertions, deletions and substitutions of bytes from one word to the other (Levenshtein 1966): the
/// nearest known name is the one to suggest for an unknown one.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// With a dash for all that a file's name cannot hold everywhere: letters, digits, '.', '_' and '-' stay.
std::string plain_name(std::string text);

/// As text or as the value of an attribute in HTML and SVG.
std::string escape_markup(std::string_view text);

}  // namespace weft
