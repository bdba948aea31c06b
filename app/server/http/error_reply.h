// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::app {

/// The status an error is answered with where nothing fits better.
int http_status_of(ErrorKind kind);

/// {"error": {"kind", "what", "where", "why", "remedy"}}, with "code" where code_of() has one.
Json error_document(const Error& error);
/// A word by which a program tells what this server decided, whatever its sentences become: "rig_busy".
/// Empty for an error of another room.
std::string_view code_of(const Error& error);
/// Every such word.
std::vector<std::string_view> error_codes();

/// The error for an exception of the standard library, which is no reason for a daemon to end: kTryAgain
/// where memory ran out, else kInternal.
Error error_of_exception(const std::exception& thrown, const std::string& where);

/// What error_document() made; anything else is kProtocol of `where`.
Error error_of_document(const std::string& text, const std::string& where);

/// The document as one line; bytes that are no UTF-8 become U+FFFD.
std::string line_of(const Json& document);

}  // namespace weft::app
