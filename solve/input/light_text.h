// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

// Tables of numbers that people write as text.

namespace weft::solve {

/// The error of a file of lights: kBadData, "lights cannot be read".
Error bad_lights(const std::filesystem::path& file, std::string why);

/// A line of a text, without comments and blank ones.
struct TextLine {
  int number = 0;  ///< from 1
  std::string text;
};
struct TextLines {
  std::vector<TextLine> lines;
  std::vector<std::string> assumed = {};
};
/// The lines of UTF-8 or UTF-16 with or without a byte order mark, ended by LF, CR LF or CR. Lines that begin
/// with '#', ';', '%' or "//" are comments. kBadData for what is no text.
Result<TextLines> lines_of(std::string_view bytes, const std::filesystem::path& file);

/// What stands in a line: text, then numbers.
struct LightRow {
  int line = 0;
  std::string name = {};  ///< empty: there are numbers alone
  std::vector<double> numbers = {};
};
struct LightRows {
  std::vector<std::string> columns = {};      ///< names of the numbers, in small letters; empty: no heading
  std::optional<std::size_t> announced = {};  ///< by a count in the first line
  std::vector<LightRow> rows = {};
};

/// The rows of a table. Words are parted by blanks, tabs, ';' or ','. Numbers have points, or all of them
/// decimal commas, which `assumed` then says. Rows have names, or none has. kBadData with the line.
Result<LightRows> rows_of(const std::vector<TextLine>& lines, const std::filesystem::path& file,
                          std::vector<std::string>& assumed);

}  // namespace weft::solve
