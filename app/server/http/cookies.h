// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace weft::app {

/// The value of a cookie in a Cookie header (RFC 6265, 5.4), the first of that name; empty where there is
/// none.
std::string_view cookie_in(std::string_view header, std::string_view name);

}  // namespace weft::app
