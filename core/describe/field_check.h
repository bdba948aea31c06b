// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "core/describe/fields.h"

namespace weft {

/// Holds each field against its range and its rules.
class FieldCheck final : public Fields {
 public:
  void require(bool holds, const char* field, const std::string& rule) override;
  /// The first field that is wrong: kUsage.
  Result<void> status() const { return error_ ? Result<void>(*error_) : Result<void>(); }

 private:
  void hold(const Field& field, double number, bool is_whole);
  void hold_word(const Field& field, const std::string& word);
  void hold_count(const Field& field, std::size_t count);
  void take(const Field& field, Value value) override;
  void choose(const Field& field, Words words, std::size_t now,
              const std::function<void(std::size_t)>& choose) override;
  void repeat(const Field& field, std::size_t count, const std::function<void(std::size_t)>& resize,
              const std::function<void(Fields&, std::size_t)>& inside) override;

  std::optional<Error> error_;
};

/// Whether what is described keeps to its ranges. kUsage with the field's name.
template <typename Described>
Result<void> check_fields(Described described) {
  FieldCheck check;
  describe(check, described);
  return check.status();
}

}  // namespace weft
