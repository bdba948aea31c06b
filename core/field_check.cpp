// SPDX-License-Identifier: Apache-2.0
#include "core/field_check.h"

#include <fmt/format.h>

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
        if constexpr (std::is_same_v<T, int> || std::is_same_v<T, double>) {
          hold(field, *each, std::is_same_v<T, int>);
        } else if constexpr (std::is_same_v<T, std::optional<int>> ||
                             std::is_same_v<T, std::optional<double>>) {
          if (*each) hold(field, **each, std::is_same_v<T, std::optional<int>>);
        } else if constexpr (std::is_same_v<T, std::vector<int>> || std::is_same_v<T, std::vector<double>>) {
          hold_count(field, each->size());
          for (const auto one : *each) hold(field, one, std::is_same_v<T, std::vector<int>>);
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
