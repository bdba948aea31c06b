// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/base/json_document.h"

namespace weft::app {

/// What a field may hold, in words: "whole number 1 to 10", "list of text", "text or null". Of JSON Schema
/// or of OpenAPI.
std::string kind_of(const Json& schema);

/// A table of the fields of an object: a row a field, what is within behind its own: `leds[].mu`.
std::string field_table(const Json& schema);

}  // namespace weft::app
