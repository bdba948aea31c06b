// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace weft::app {

/// What a request may be at most.
struct FrameLimits {
  std::size_t target_bytes = 1024;
  std::size_t line_bytes = 4096;
  std::size_t head_bytes = 16384;  ///< request line and headers
  std::size_t headers = 64;
  std::size_t range_bytes = 100;  ///< of the Range header's value
  std::size_t body_bytes = 65536;
};

/// How far a request is.
struct RequestFrame {
  std::size_t bytes = 0;      ///< of the whole request once it is there; 0: more must come
  bool last = false;          ///< its client takes no further answer on this connection
  int status = 0;             ///< not 0: it is refused with this HTTP status
  std::string_view why = {};  ///< of a refusal
};

/// Judges the bytes a client has sent so far, before anything is parsed for its meaning. Taken are requests
/// of HTTP/1.0 and 1.1 (RFC 9112, 2022) whose lines end in CR LF and whose body has a Content-Length; not
/// taken is what a small interface never needs and what has made servers run out of stack or memory: chunked
/// or compressed bodies, many ranges, folded headers, two of a header that must be one.
RequestFrame frame_request(std::string_view received, const FrameLimits& limits);

}  // namespace weft::app
