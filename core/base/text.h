// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace weft {

/// Insertions, deletions and substitutions of bytes from one word to the other (Levenshtein 1966): the
/// nearest known name is the one to suggest for an unknown one.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// With the capitals of ASCII as small letters.
std::string small_letters(std::string_view text);

/// Whether one name stands before another as people count: "DSC_9" before "DSC_10", capitals as small
/// letters. Names that differ in nothing but that keep the order of their bytes.
bool stands_before(std::string_view a, std::string_view b);

/// "a, b, c and 9 more", of so many names in all as there are or as `count` says.
std::string first_few(const std::vector<std::string>& names, std::size_t count = 0);

/// With a dash for each character that a file's name cannot hold everywhere: letters and digits of any script
/// with their marks, '.', '_' and '-' stay; blanks, punctuation, symbols, control and format characters and
/// what is no UTF-8 do not.
std::string plain_name(std::string text);

/// A name for the file of what people call `text`: plain, without a dash or dot at its ends and two dashes
/// side by side, at most `most_bytes` long in whole characters; `otherwise` where nothing is left.
std::string file_name_of(std::string_view text, std::string_view otherwise, std::size_t most_bytes = 120);

/// As text or as the value of an attribute in HTML and SVG.
std::string escape_markup(std::string_view text);

}  // namespace weft
