// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace weft::app {

/// Whether a path, not decoded, is of this pattern: {...} stands for one segment.
bool fits(std::string_view pattern, std::string_view path);

}  // namespace weft::app
