// SPDX-License-Identifier: Apache-2.0
#include "core/describe/field_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

namespace weft {

void FieldCheck::require(bool holds, const char* field, const std::string& rule) {
  if (holds || error_) return;
  error_ = Error{ErrorKind::kUsage, "option is out of its range", field, rule, "give a value in that range"};
}

void FieldCheck::hold(const Field& field, double number, bool is_whole) {
  if (field.range.holds(number)) return;
  require(false, field.name, fmt::format("{}, and is {}", rule_of(field.range, is_whole), number));
}

void FieldCheck::hold_word(const Field& field, const std::string& word) {
  if (word.empty() || field.words.empty() || std::ranges::find(field.words, word) != field.words.end())
    return;
  require(false, field.name, rule_of_words(field.words, word));
}

void FieldCheck::hold_count(const Field& field, std::size_t count) {
  const bool is_free = field.most == 0 || count == 0;
  const bool is_within =
      count >= static_cast<std::size_t>(field.fewest) && count <= static_cast<std::size_t>(field.most);
  require(is_free || is_within, field.name,
          fmt::format("must be {} to {} values, and is {}", field.fewest, field.most, count));
}

void FieldCheck::take(const Field& field, Value value) {
  std::visit(
      [&]<typename T>(T* each) {
        using Held = typename Inner<T>::Type;
        const auto hold_one = [&](const Held& held) {
          if constexpr (std::is_same_v<Held, int> || std::is_same_v<Held, double>)
            hold(field, held, std::is_same_v<Held, int>);
          if constexpr (std::is_same_v<Held, std::string>) hold_word(field, held);
        };
        if constexpr (kIsList<T>) {
          hold_count(field, each->size());
          for (const Held& held : *each) hold_one(held);
        } else if constexpr (kIsOptional<T>) {
          if (*each) hold_one(**each);
        } else {
          hold_one(*each);
        }
      },
      value);
}

void FieldCheck::choose(const Field& /*field*/, Words /*words*/, std::size_t /*now*/,
                        const std::function<void(std::size_t)>& /*choose*/) {}

void FieldCheck::repeat(const Field& /*field*/, std::size_t count,
                        const std::function<void(std::size_t)>& /*resize*/,
                        const std::function<void(Fields&, std::size_t)>& inside) {
  for (std::size_t i = 0; i < count; ++i) inside(*this, i);
}

}  // namespace weft
