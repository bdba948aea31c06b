// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <concepts>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace weft {

/// The finite decimal number that all of `text` is, whatever the locale: "-1.5e3" and "+2", never "1.5abc",
/// "1,5", "0x10", "nan" or "1e400".
std::optional<double> as_number(std::string_view text);

/// The whole number that all of `text` is, in digits: "12" and, of a type that has it, "-3".
template <std::integral T>
std::optional<T> as_whole_number(std::string_view text) {
  T number = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failed != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// Why as_number() finds none, for a person: "\"2,23\" has a decimal comma and is no number: write 2.23".
std::string why_no_number(std::string_view text);

/// The words of a line between blanks, tabs and carriage returns.
std::vector<std::string_view> words_of_line(std::string_view line);

/// What a number may be, both ends with it.
struct NumberRange {
  double least = -std::numeric_limits<double>::max(), most = std::numeric_limits<double>::max();
  constexpr bool holds(double number) const { return number >= least && number <= most; }
};

}  // namespace weft
