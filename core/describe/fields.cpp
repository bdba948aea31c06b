// SPDX-License-Identifier: Apache-2.0
#include "core/describe/fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/text.h"

namespace weft {
namespace {

constexpr std::size_t kMostCompared = 60;

}  // namespace

std::string option_of(const Field& field) {
  if (field.option != nullptr) return field.option;
  std::string name = field.name;
  for (const std::string_view unit : {"_mm", "_deg", "_percent", "_px", "_us", "_s"}) {
    if (!name.ends_with(unit)) continue;
    name.resize(name.size() - unit.size());
    break;
  }
  std::ranges::replace(name, '_', '-');
  return "--" + name;
}

std::string rule_of(const NumberRange& range, bool is_whole) {
  const char* number = is_whole ? "must be a whole number" : "must be a number";
  const bool is_above_zero = range.least == kAboveZero.least, has_end = range.most < kMostNumber;
  if (is_above_zero && has_end) return fmt::format("{} above 0, at most {}", number, range.most);
  if (is_above_zero) return fmt::format("{} above 0", number);
  if (has_end) return fmt::format("{} from {} to {}", number, range.least, range.most);
  return range.least > -kMostNumber ? fmt::format("{} of at least {}", number, range.least) : number;
}

std::string nearest_word(const std::vector<std::string>& words, std::string_view said) {
  const std::string_view start = said.substr(0, kMostCompared);
  return *std::ranges::min_element(words, {},
                                   [&](const std::string& word) { return edit_distance(start, word); });
}

std::string rule_of_words(const std::vector<std::string>& words, std::string_view said) {
  return fmt::format("must be one of {}, and is \"{}\"; did you mean '{}'", fmt::join(words, ", "),
                     said.substr(0, kMostCompared), nearest_word(words, said));
}

void Fields::enter(const Field& /*field*/, const std::function<void(Fields&)>& inside, bool /*is_default*/) {
  inside(*this);
}

void Fields::repeat(const Field& /*field*/, std::size_t /*count*/,
                    const std::function<void(std::size_t)>& /*resize*/,
                    const std::function<void(Fields&, std::size_t)>& /*inside*/) {}

}  // namespace weft
