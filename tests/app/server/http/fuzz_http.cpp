// SPDX-License-Identifier: Apache-2.0
// libFuzzer program: any bytes as a request's frame, as its cookies, tags and range and, after its first
// empty line, as the body of a scan.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "app/server/api/bodies/scan_body.h"
#include "app/server/http/cookies.h"
#include "app/server/http/error_reply.h"
#include "app/server/http/request_frame.h"
#include "app/server/http/request_headers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace weft::app;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const RequestFrame frame = frame_request(text, {});
  if (frame.bytes > size || (frame.status != 0 && frame.why.empty())) std::abort();

  if (cookie_in(text, "weft_8470").size() > size) std::abort();

  if (takes_coding(text, "gzip") && text.find("gzip") == std::string_view::npos) std::abort();
  constexpr std::uint64_t kFileBytes = 1000;
  for (const std::string& header : {std::string(text), "bytes=" + std::string(text)}) {
    const AskedRange range = asked_range(header, kFileBytes);
    const bool is_part = range.is == AskedRange::Is::kPart;
    if (is_part && (range.bytes == 0 || range.first + range.bytes > kFileBytes)) std::abort();
  }
  // Who has a tag names it, whatever else the list holds before.
  const bool is_list = names_tag(std::string(text) + ", \"weft\"", "weft");
  if (names_tag(text, "weft") && text.find("weft") == std::string_view::npos &&
      text.find('*') == std::string_view::npos) {
    std::abort();
  }
  if (is_list && size > 0 && text.find('"') == std::string_view::npos &&
      text.find_first_not_of(" \t,") != std::string_view::npos) {
    std::abort();
  }

  const std::size_t head_end = text.find("\r\n\r\n");
  const auto body = parse_body(head_end == std::string_view::npos ? text : text.substr(head_end + 4));
  if (!body) return line_of(error_document(body.error())).empty();
  const auto request = read_scan_body(*body, 10, {});
  if (!request) return line_of(error_document(request.error())).empty();
  if (request->leds.size() > 10 || request->fabric.size() > 200) std::abort();
  return request->metadata.dump().empty();
}
