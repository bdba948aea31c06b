// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/error_json.h"

#include <new>

#include "core/error_json.h"

namespace weft::app {

int http_status_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kUsage:
      return 400;
    case ErrorKind::kNoInput:
      return 404;
    case ErrorKind::kCannotCreate:
    case ErrorKind::kTryAgain:
      return 409;
    case ErrorKind::kBadData:
      return 422;
    case ErrorKind::kInternal:
    case ErrorKind::kInputOutput:
      return 500;
    case ErrorKind::kProtocol:
      return 502;
    case ErrorKind::kNoDevice:
    case ErrorKind::kInterrupted:
      return 503;
  }
  return 500;
}

Json error_document(const Error& error) {
  return {{"error", json_of(error)}};
}

Error error_of_exception(const std::exception& thrown, const std::string& where) {
  if (dynamic_cast<const std::bad_alloc*>(&thrown) != nullptr) {
    return {ErrorKind::kTryAgain, "not enough memory", where, "the system refused some",
            "close other programs and run the same command again"};
  }
  return {ErrorKind::kInternal, "a bug in weft", where, thrown.what(),
          "run the same command again, and report it with what you did"};
}

Error error_of_document(const std::string& text, const std::string& where) {
  const Json document = Json::parse(text, nullptr, false);
  if (document.is_object() && document.contains("error")) return error_of_json(document["error"], where);
  return {ErrorKind::kProtocol, "the answer is not a daemon's", where, text.substr(0, 200),
          "check that the address is that of weft serve"};
}

std::string line_of(const Json& document) {
  return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace weft::app
