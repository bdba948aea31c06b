// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/describe/field_json.h"
#include "core/describe/fields.h"
#include "core/toml/toml_json.h"

namespace weft {

/// What is wrong with a file that a person wrote: kBadData at `where`; `page` is where its keys are
/// explained.
Error unusable_description(std::string where, const std::string& page, std::string why);

/// "there is no such key; the nearest is mask"
std::string no_such_key(const std::vector<std::string>& known, std::string_view key);

/// Reads the fields that `walk` goes over from a table that a person wrote; `schema` says which there are.
/// Every other key is wrong, and the nearest is named. What is wrong is an unusable_description() at
/// "`where`: key"; `page` is as "docs/rig.md".
Result<void> read_table(const toml::table& table, const std::string& where, const std::string& page,
                        const Json& schema, const std::function<void(Fields&)>& walk);

template <typename Described>
Result<Described> read_fields(const toml::table& table, const std::string& where, const std::string& page) {
  Described read;
  const auto walk = [&read](Fields& fields) { describe(fields, read); };
  if (Result<void> ok = read_table(table, where, page, schema_of<Described>(), walk); !ok)
    return std::move(ok).error();
  return read;
}

template <typename Described>
Result<Described> read_file(const std::filesystem::path& file, const std::string& page) {
  const Result<toml::table> table = read_toml(file);
  if (!table) return table.error();
  return read_fields<Described>(*table, file.string(), page);
}

/// An object of texts, numbers, flags, lists of them and lists of such objects as TOML.
std::string toml_of(const Json& object);

}  // namespace weft
