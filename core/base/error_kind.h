// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace weft {

/// "bad_data": what processes and HTTP clients call this kind.
const char* name_of(ErrorKind kind);
/// All of them.
std::vector<const char*> error_kind_names();
/// The kind of this name, if there is one.
std::optional<ErrorKind> error_kind_of(std::string_view name);

}  // namespace weft
