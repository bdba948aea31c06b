// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/options.h"
#include "core/describe/fields.h"

namespace weft::app {

/// Adds an option for each field, with its range, its help and its default.
class OptionFields final : public Fields {
 public:
  explicit OptionFields(Options& options) : options_(options) {}

  void exclude(const char* field, const char* other) override;
  void need(const char* field, const char* other) override;
  void need_one(const std::vector<const char*>& fields) override;

 private:
  /// Not what a server alone is told.
  bool has(const char* field) const { return options_by_field_.contains(field); }
  Option add_amount(const Field& field, std::optional<double>& amount);
  Option add_document(const Field& field, Json& document);
  void take(const Field& field, Value value) override;
  void choose(const Field& field, Words words, std::size_t now,
              const std::function<void(std::size_t)>& choose) override;

  Options& options_;
  std::map<std::string, Option> options_by_field_;
};

/// `described` must live until the verb has run.
template <typename Described>
void add_options(Options& options, Described& described) {
  OptionFields fields(options);
  describe(fields, described);
}

}  // namespace weft::app
