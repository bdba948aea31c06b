// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <string_view>

#include "core/base/descriptor.h"
#include "core/base/json_document.h"

namespace weft::app {

/// A connection that says what it likes, as no HTTP client would.
class RawClient {
 public:
  /// To 127.0.0.1. Check connected().
  explicit RawClient(int port);
  bool connected() const { return static_cast<bool>(socket_); }
  /// False once the server does not take it.
  bool say(std::string_view bytes);
  /// Says no more; the server may still answer.
  void end_of_words();
  /// What arrives until `end` has been seen, the server closes, or the time is over.
  std::string hear(std::chrono::milliseconds most, std::string_view end = "\n\n\n\n never");
  /// At most so many bytes, as many as come within a tenth of a second.
  std::string hear_some(std::size_t most);
  /// Whether the server has closed the connection by then.
  bool closed_within(std::chrono::milliseconds most);

 private:
  Descriptor socket_;
};

struct Answer {
  int status = 0;  ///< 0: none came
  std::string head, body;
  /// The body as JSON; a failed expectation where it is none.
  Json json() const;
};
/// The first answer of what was heard.
Answer parsed(const std::string& response);

using HeaderLines = std::map<std::string, std::string>;

/// One whole request, with the headers that a well-behaved client of one request sends; `headers` replace or
/// add to them.
std::string request_text(int port, const std::string& method, const std::string& target,
                         const std::string& body = "", const HeaderLines& headers = {});
Answer ask(int port, const std::string& method, const std::string& target, const std::string& body = "",
           const HeaderLines& headers = {});

}  // namespace weft::app
