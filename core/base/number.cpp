// SPDX-License-Identifier: Apache-2.0
#include "core/base/number.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weft {
namespace {

constexpr std::size_t kLongestQuote = 40;

/// "2.23" of "2,23"; empty where that is no number either.
std::string with_a_point(std::string_view text) {
  std::string pointed(text);
  const std::size_t comma = pointed.find(',');
  if (comma == pointed.npos) return {};
  pointed[comma] = '.';
  return as_number(pointed) ? pointed : std::string();
}

}  // namespace

std::optional<double> as_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double number = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_whole = failed == std::errc() && end == text.data() + text.size();
  return is_whole && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

std::string why_no_number(std::string_view text) {
  const std::string quoted = fmt::format("\"{}\"", text.substr(0, kLongestQuote));
  if (const std::string pointed = with_a_point(text); !pointed.empty())
    return quoted + " has a decimal comma and is no number: write " + pointed;
  double number = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failed == std::errc::result_out_of_range) return quoted + " is beyond what a number here can be";
  if (failed == std::errc() && !std::isfinite(number)) return quoted + " is no finite number";
  return quoted + " is no number";
}

std::vector<std::string_view> words_of_line(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r";
  std::vector<std::string_view> words;
  for (std::size_t begin = 0; (begin = line.find_first_not_of(kBlanks, begin)) != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = end;
  }
  return words;
}

}  // namespace weft
