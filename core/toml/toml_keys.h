// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace weft {

/// The table of a text; `where` is its file. kBadData with the line.
Result<toml::table> parse_toml(std::string_view text, const std::string& where);
/// Reads a TOML file. kNoInput; kBadData with the line.
Result<toml::table> read_toml(const std::filesystem::path& file);

/// Typed access to one table of a file that a person wrote, as JsonFields is to one that a program wrote: the
/// first thing that is wrong is remembered, every later read returns a default, and `status()` ends the list.
/// What is wrong is kBadData at "`where`: key"; `page` is where its keys are explained ("docs/rig.md").
class TomlKeys {
 public:
  TomlKeys(const toml::table& table, std::string where, std::string page)
      : table_(&table), where_(std::move(where)), page_(std::move(page)) {}

  /// Every other key is wrong.
  void know(std::initializer_list<std::string_view> names);
  bool has(const char* key) const { return table_->get(key) != nullptr; }
  double number(const char* key, double least, double most);
  double number_or(const char* key, double otherwise, double least, double most);
  int integer_or(const char* key, int otherwise, int least, int most);
  /// `fewest` to `most` finite numbers in brackets, or one alone where `fewest` is 1.
  std::vector<double> numbers(const char* key, std::size_t fewest, std::size_t most);
  /// `value`, which must be within.
  double within(const char* key, double value, double least, double most);
  bool flag_or(const char* key, bool otherwise);
  std::string text_or(const char* key, std::string otherwise);
  std::vector<std::string> texts_or(const char* key, std::vector<std::string> otherwise);
  /// The table [key], empty where there is none.
  const toml::table& table(const char* key);
  /// The tables of [[key]], at least one.
  std::vector<const toml::table*> tables(const char* key);

  void reject(const std::string& key, std::string why);
  Result<void> status() const { return error_ ? Result<void>(*error_) : Result<void>(); }

 private:
  const toml::table* table_;
  std::string where_, page_;
  std::optional<Error> error_;
};

}  // namespace weft
