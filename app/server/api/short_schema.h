// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/json_document.h"

namespace weft::app {

/// A schema of OpenAPI of how the files of the resources say it:
///
///   {"//": "list: The gravest first", "session": "text", "turn_deg": "number or null: Mean", "picture?":
///   "text"}
///
/// An object has its fields, those with "?" may be absent, and in "//" says what it is itself: a list of
/// such, null, both, and a description. A field is text, flag, number, whole, object, a|b|c, or the name of a
/// component; before it may stand "list of", behind it "or null" and a description. Whatever has a "type" of
/// OpenAPI, or "$ref", "allOf", "oneOf", "additionalProperties", is OpenAPI already.
Json written_out(const Json& short_schema);

}  // namespace weft::app
