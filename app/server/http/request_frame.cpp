// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/request_frame.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

namespace weft::app {
namespace {

RequestFrame refuse(int status, std::string_view why) {
  return {0, true, status, why};
}

// A token of RFC 9110, section 5.6.2: ASCII in any locale.
bool is_token(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    return letter || (c >= '0' && c <= '9') ||
           std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
  });
}

bool is_printable(std::string_view text) {
  return std::ranges::all_of(text, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte >= 0x20 && byte != 0x7f) || c == '\t';
  });
}

bool is_name(std::string_view text, std::string_view lower) {
  return std::ranges::equal(text, lower, [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a + 'a' - 'A') : a) == b;
  });
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

std::string_view cut_line(std::string_view& text) {
  const std::size_t end = text.find("\r\n");
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 2);
  return line;
}

std::optional<RequestFrame> judge_request_line(std::string_view line, const FrameLimits& limits) {
  const std::size_t first = line.find(' '), last = line.rfind(' ');
  if (first == std::string_view::npos || first == last) return refuse(400, "the request line has no target");
  const std::string_view method = line.substr(0, first), target = line.substr(first + 1, last - first - 1);
  const std::string_view version = line.substr(last + 1);
  if (method.size() > 16 || !is_token(method)) return refuse(400, "the method is no word");
  if (version != "HTTP/1.1" && version != "HTTP/1.0") return refuse(505, "HTTP/1.1 and 1.0 are spoken here");
  if (target.size() > limits.target_bytes) return refuse(414, "the target is too long");
  if (target.empty() || target[0] != '/' || target.find_first_of(" \t#") != std::string_view::npos) {
    return refuse(400, "the target is no path");
  }
  return std::nullopt;
}

// With two of these, two readers of one request could see two different ones.
constexpr std::array<std::string_view, 12> kOnlyOnce = {
    "host",           "origin",         "authorization", "content-type", "content-length", "cookie",
    "sec-fetch-site", "sec-fetch-mode", "last-event-id", "range",        "if-range",       "if-none-match"};

/// What the headers have said so far.
struct Head {
  std::size_t headers = 0;
  std::array<bool, kOnlyOnce.size()> seen = {};
  std::size_t body_bytes = 0;
  bool last = false;
};

/// Whether a list of words, which commas separate, has this one.
bool names(std::string_view list, std::string_view word) {
  while (!list.empty()) {
    const std::string_view each = list.substr(0, list.find(','));
    if (is_name(trimmed(each), word)) return true;
    list.remove_prefix(std::min(each.size() + 1, list.size()));
  }
  return false;
}

std::optional<RequestFrame> judge_length(std::string_view value, const FrameLimits& limits, Head& head) {
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), head.body_bytes);
  if (value.empty() || end != value.data() + value.size() || error == std::errc::invalid_argument) {
    return refuse(400, "the Content-Length is no number");
  }
  if (error == std::errc::result_out_of_range || head.body_bytes > limits.body_bytes) {
    return refuse(413, "the body is too long");
  }
  return std::nullopt;
}

std::optional<RequestFrame> judge_header(std::string_view line, const FrameLimits& limits, Head& head) {
  const std::size_t colon = line.find(':');
  if (line.size() > limits.line_bytes || ++head.headers > limits.headers) {
    return refuse(431, "the headers are too long");
  }
  if (colon == std::string_view::npos || !is_token(line.substr(0, colon))) {
    return refuse(400, "a header has no name");
  }
  const std::string_view name = line.substr(0, colon), value = trimmed(line.substr(colon + 1));
  if (is_name(name, "transfer-encoding")) return refuse(411, "the body needs a Content-Length");
  if (is_name(name, "content-encoding")) return refuse(415, "compressed bodies are not taken");
  if (is_name(name, "range") && value.size() > limits.range_bytes) return refuse(416, "one range is served");
  if (is_name(name, "connection") && names(value, "close")) head.last = true;
  for (std::size_t i = 0; i < kOnlyOnce.size(); ++i) {
    if (!is_name(name, kOnlyOnce[i])) continue;
    if (head.seen[i]) return refuse(400, "a header is there twice that must be one");
    head.seen[i] = true;
  }
  if (is_name(name, "content-length")) return judge_length(value, limits, head);
  return std::nullopt;
}

}  // namespace

RequestFrame frame_request(std::string_view received, const FrameLimits& limits) {
  const std::size_t head_end = received.substr(0, limits.head_bytes).find("\r\n\r\n");
  std::string_view head = received.substr(0, std::min(head_end, limits.head_bytes));
  const bool whole_head = head_end != std::string_view::npos;
  if (!whole_head && received.size() >= limits.head_bytes) return refuse(431, "the headers are too long");
  // A TLS hello or noise is told at its first bytes, not at the deadline.
  if (!is_token(head.substr(0, 1)) && !head.empty()) return refuse(400, "this is no HTTP");
  if (!whole_head) return {};

  const std::string_view request_line = cut_line(head);
  if (const auto refused = judge_request_line(request_line, limits)) return *refused;
  Head found;
  found.last = request_line.ends_with("HTTP/1.0");
  while (!head.empty()) {
    const std::string_view line = cut_line(head);
    if (!is_printable(line)) return refuse(400, "a header holds control characters");
    if (const auto refused = judge_header(line, limits, found)) return *refused;
  }
  const std::size_t bytes = head_end + 4 + found.body_bytes;
  return {received.size() >= bytes ? bytes : 0, found.last, 0, {}};
}

}  // namespace weft::app
