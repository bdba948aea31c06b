// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft {

/// The table of a text; `where` is its file. kBadData with the line.
Result<toml::table> parse_toml(std::string_view text, const std::string& where);
/// Reads a TOML file. kNoInput; kBadData with the line.
Result<toml::table> read_toml(const std::filesystem::path& file);

/// Tables become objects and arrays lists, numbers keep their kind; dates and times become null.
Json json_of(const toml::node& node);

/// A list of lists of `each` finite numbers, as of corners in pixels; nothing where it is another thing.
std::optional<std::vector<std::vector<double>>> rows_of(const Json& list, std::size_t each);

}  // namespace weft
