// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/base/json_document.h"

namespace weft::app {

/// The calls of the server as a page of Markdown, from api_description(): docs/reference/calls.md without its
/// last line end.
std::string calls_page(const Json& description);

}  // namespace weft::app
