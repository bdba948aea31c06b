// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/json_document.h"
#include "core/result.h"

namespace weft::app {

/// "bad_data": what the HTTP interface calls this kind.
const char* kind_name(ErrorKind kind);

/// The status an error is answered with where nothing fits better.
int http_status_of(ErrorKind kind);

/// {"error": {"kind", "what", "where", "why", "remedy"}}
Json error_document(const Error& error);

/// What error_document() made; anything else is kProtocol of `where`.
Error error_of_document(const std::string& text, const std::string& where);

/// The document as one line; bytes that are no UTF-8 become U+FFFD.
std::string line_of(const Json& document);

}  // namespace weft::app
