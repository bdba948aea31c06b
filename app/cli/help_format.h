// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace CLI {
class App;
}  // namespace CLI

namespace weft::app {

/// Columns of the terminal that standard output is, 60 to 120; 100 where it is none.
std::size_t columns_of_help();

/// The help of a program and of its verbs, its lines broken between words to fit so many columns.
void format_help(CLI::App& program, std::size_t columns);

/// The text in lines of at most `columns`, each but the first behind `indent` spaces. A word that is longer
/// stands alone; line ends stay.
std::string wrapped(const std::string& text, std::size_t columns, std::size_t indent);

}  // namespace weft::app
