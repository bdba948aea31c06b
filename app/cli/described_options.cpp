// SPDX-License-Identifier: Apache-2.0
#include "app/cli/described_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <type_traits>

#include "core/base/number.h"

namespace weft::app {
namespace {

// A word without a dash is called as its field is.
std::string names_of(const Field& field) {
  const std::string option = option_of(field);
  return option.empty() ? field.name : option;
}

template <typename T>
void keep_to(const NumberRange& range, const Option& option) {
  if constexpr (std::is_same_v<T, int>) {
    if (range.most < kMostNumber)
      return static_cast<void>(option.in_range(static_cast<int>(range.least), static_cast<int>(range.most)));
  }
  if constexpr (std::is_same_v<T, int> || std::is_same_v<T, double>) {
    if (range.least == kAboveZero.least) {
      option.above_zero(std::is_same_v<T, int>);
    } else if (range.least == 0 && range.most == kMostNumber) {
      option.not_negative(std::is_same_v<T, int>);
    } else if (range.least > -kMostNumber) {
      option.in_range(range);
    }
  }
}

// Words without a dash stand side by side, and what stands between commas may hold none.
void list_as(const Field& field, bool is_of_numbers, const Option& option) {
  if (!names_of(field).starts_with('-')) return;
  if (field.is_said_again) option.one_at_a_time();
  if (is_of_numbers || !field.is_said_again) option.by_commas();
}

// "1/60" of what stands behind it.
std::optional<double> read_share(std::string_view text) {
  const std::size_t slash = text.find('/');
  const std::optional<double> number = as_number(text.substr(0, slash));
  if (slash == text.npos || !number) return number;
  const std::optional<double> below = as_number(text.substr(slash + 1));
  return below ? std::optional(*number / *below) : std::nullopt;
}

// "8h" in seconds; why it is none.
std::string read_amount(const Field& field, const std::string& text, double& amount) {
  const bool is_of_a_second = text.find('/') != text.npos && text.back() >= '0' && text.back() <= '9';
  const std::string spelled = is_of_a_second ? text + "s" : text;  // "1/60", as cameras have it
  std::string names;
  for (const NumberUnit& unit : field.units) {
    names += fmt::format("{}{}",
                         names.empty()                  ? ""
                         : &unit == &field.units.back() ? " or "
                                                        : ", ",
                         *unit.name == '\0' ? "nothing" : unit.name);
    if (!spelled.ends_with(unit.name)) continue;
    std::string_view said =
        std::string_view(spelled).substr(0, spelled.size() - std::string_view(unit.name).size());
    said = said.substr(0, said.find_last_not_of(' ') + 1);
    const std::optional<double> number = read_share(said);
    if (!number && said.find(',') != said.npos) return why_no_number(said);
    if (!number) continue;
    amount = *number * unit.size;
    if (field.range.holds(amount)) return "";
    return fmt::format("{} {}, and is {}", rule_of(field.range), field.units.front().name, text);
  }
  return fmt::format("\"{}\" is no number with {} behind it, such as 20{}", text, names,
                     field.units.front().name);
}

}  // namespace

void OptionFields::exclude(const char* field, const char* other) {
  if (has(field) && has(other)) options_by_field_.at(field).excludes(options_by_field_.at(other));
}

void OptionFields::need(const char* field, const char* other) {
  if (has(field) && has(other)) options_by_field_.at(field).needs(options_by_field_.at(other));
}

void OptionFields::need_one(const std::vector<const char*>& fields) {
  std::vector<Option> options;
  for (const char* field : fields) {
    if (has(field)) options.push_back(options_by_field_.at(field));
  }
  options_.need_one(options);
}

Option OptionFields::add_amount(const Field& field, std::optional<double>& amount) {
  return options_.add_text(
      names_of(field),
      [field, &amount](const std::string& text) {
        double read = 0;
        std::string why = read_amount(field, text, read);
        if (why.empty()) amount = read;
        return why;
      },
      field.says);
}

Option OptionFields::add_document(const Field& field, Json& document) {
  if (field.is_said_again) {
    return options_.add_texts(
        names_of(field),
        [&document](const std::string& text) {
          const std::size_t equals = text.find('=');
          if (equals == 0 || equals == text.npos) return fmt::format("must be KEY=VALUE, and is {}", text);
          document[text.substr(0, equals)] = text.substr(equals + 1);
          return std::string();
        },
        field.says);
  }
  return options_.add_text(
      names_of(field),
      [&document](const std::string& text) {
        Json read = Json::parse(text, nullptr, false);
        if (read.is_discarded()) return std::string("must be JSON");
        document = std::move(read);
        return std::string();
      },
      field.says);
}

void OptionFields::take(const Field& field, Value value) {
  if (field.said == Said::kToServer) return;
  const Option added = std::visit(
      [&]<typename T>(T* each) {
        if constexpr (std::is_same_v<T, bool>) {
          return options_.add_flag(names_of(field), each, field.says);
        } else if constexpr (std::is_same_v<T, Json>) {
          return add_document(field, *each);
        } else {
          if constexpr (std::is_same_v<T, std::optional<double>>)
            if (!field.units.empty()) return add_amount(field, *each);
          const Option option = options_.add(names_of(field), each, field.says);
          if (field.need == kMustSay) option.required();
          if constexpr (kIsList<T>) list_as(field, std::is_arithmetic_v<typename Inner<T>::Type>, option);
          if (kIsList<T> && field.most > 0) option.takes(field.fewest, field.most);
          if (!field.words.empty() && field.path != PathTo::kNamed) option.one_of(field.words);
          keep_to<typename Inner<T>::Type>(field.range, option);
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
