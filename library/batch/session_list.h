// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace weft::library {

/// The folders of sessions that a text names, in its order: what other verbs print, or a list that somebody
/// wrote.
///
/// JSON: `numbers.affected` of `weft calibrate history --affected --json`, `sessions` of `weft library find
/// --json`, or a list of texts. Else lines: a line that ends in .weft, or begins with a slash or a dot, is a
/// folder; of a row of a table that names one what stands before the end of its .weft is. Other lines are
/// headings.
std::vector<std::string> sessions_of_text(std::string_view text);

}  // namespace weft::library
