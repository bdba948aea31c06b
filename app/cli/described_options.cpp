// SPDX-License-Identifier: Apache-2.0
#include "app/cli/described_options.h"

#include <type_traits>

namespace weft::app {
namespace {

template <typename T>
constexpr bool kIsList = false;
template <typename T>
constexpr bool kIsList<std::vector<T>> = true;

// A word without a dash is called as its field is.
std::string names_of(const Field& field) {
  const std::string option = option_of(field);
  return option.empty() ? field.name : option;
}

void keep_to(const NumberRange& range, bool is_whole, const Option& option) {
  if (range.least == kAboveZero.least) {
    option.above_zero();
  } else if (range.least > -kMostNumber && is_whole) {
    option.in_range(static_cast<int>(range.least), static_cast<int>(range.most));
  } else if (range.least > -kMostNumber) {
    option.in_range(range);
  }
}

template <typename T>
constexpr bool kIsWhole =
    std::is_same_v<T, int> || std::is_same_v<T, std::optional<int>> || std::is_same_v<T, std::vector<int>>;

}  // namespace

void OptionFields::exclude(const char* field, const char* other) {
  options_by_field_.at(field).excludes(options_by_field_.at(other));
}

void OptionFields::need(const char* field, const char* other) {
  options_by_field_.at(field).needs(options_by_field_.at(other));
}

void OptionFields::take(const Field& field, Value value) {
  const Option added = std::visit(
      [&]<typename T>(T* each) {
        if constexpr (std::is_same_v<T, bool>) {
          return options_.add_flag(names_of(field), each, field.says);
        } else {
          const Option option = options_.add(names_of(field), each, field.says);
          if (field.need == Need::kMustSay) option.required();
          if constexpr (kIsList<T>) option.by_commas();
          if (field.most > 0) option.takes(field.fewest, field.most);
          if (!field.words.empty()) option.one_of(field.words);
          keep_to(field.range, kIsWhole<T>, option);
          if constexpr (std::is_arithmetic_v<T>) {
            option.shows_default();
          } else if constexpr (std::is_same_v<T, std::string> || std::is_same_v<T, std::filesystem::path>) {
            if (!each->empty()) option.shows_default();
          }
          return option;
        }
      },
      value);
  options_by_field_.emplace(field.name, added);
}

void OptionFields::choose(const Field& field, Words words, std::size_t now,
                          const std::function<void(std::size_t)>& choose) {
  options_by_field_.emplace(
      field.name, options_.add_word(names_of(field), {words.begin(), words.end()}, now, choose, field.says));
}

}  // namespace weft::app
