// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <functional>
#include <string>
#include <utility>

#include "core/field_json.h"
#include "core/fields.h"
#include "core/result.h"

namespace weft {

/// Reads the fields that `walk` goes over from a table that a person wrote; `schema` says which there are.
/// Every other key is wrong, and the nearest is named. What is wrong is kBadData at "`where`: key"; `page` is
/// where its keys are explained ("docs/rig.md").
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

/// An object of texts, numbers, flags, lists of them and lists of such objects as TOML.
std::string toml_of(const Json& object);

}  // namespace weft
