// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weft::app {

/// What stands in a path for each {...} of this pattern, one segment that is not empty; nothing where the
/// path is of another pattern.
std::optional<std::vector<std::string>> segments_in(std::string_view pattern, std::string_view path);

}  // namespace weft::app
