// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "core/describe/fields.h"

namespace weft {

void describe(Fields& fields, Error& error);

/// {"kind", "what", "where", "why", "remedy"}: an error for another process.
Json json_of(const Error& error);

/// What json_of() made of an error. kProtocol of `where` for any other document.
Error error_of_json(const Json& document, const std::string& where);

}  // namespace weft
