// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/request_headers.h"

#include <algorithm>
#include <charconv>
#include <optional>

namespace weft::app {
namespace {

void skip(std::string_view& text, std::string_view characters) {
  text.remove_prefix(std::min(text.find_first_not_of(characters), text.size()));
}

std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (end != text.data() + text.size() || text.empty()) return std::nullopt;
  if (error == std::errc::result_out_of_range) return UINT64_MAX;
  return error == std::errc() ? std::optional(number) : std::nullopt;
}

}  // namespace

bool names_tag(std::string_view header, std::string_view tag) {
  skip(header, " \t");
  if (header == "*") return true;
  bool is_named = false;
  while (!header.empty()) {
    if (header.starts_with("W/")) header.remove_prefix(2);
    if (!header.starts_with('"')) return false;
    header.remove_prefix(1);
    const std::size_t end = header.find('"');
    if (end == std::string_view::npos) return false;
    is_named = is_named || header.substr(0, end) == tag;
    header.remove_prefix(end + 1);
    skip(header, " \t");
    if (!header.empty() && header[0] != ',') return false;
    skip(header, ", \t");
  }
  return is_named;
}

bool takes_coding(std::string_view header, std::string_view coding) {
  while (!header.empty()) {
    const std::string_view each = header.substr(0, header.find(','));
    header.remove_prefix(std::min(each.size() + 1, header.size()));
    std::string_view name = each.substr(0, each.find(';'));
    skip(name, " \t");
    name = name.substr(0, name.find_last_not_of(" \t") + 1);
    if (name != coding) continue;
    const std::size_t weight = each.find("q=");
    return weight == std::string_view::npos ||
           each.find_first_of("123456789", weight) != std::string_view::npos;
  }
  return false;
}

AskedRange asked_range(std::string_view header, std::uint64_t size) {
  constexpr std::string_view kUnit = "bytes=";
  const std::size_t dash = header.find('-');
  if (!header.starts_with(kUnit) || dash == std::string_view::npos) return {};
  const std::string_view from = header.substr(kUnit.size(), dash - kUnit.size()),
                         to = header.substr(dash + 1);
  const std::optional<std::uint64_t> first = whole_number(from), last = whole_number(to);
  if ((!first && !from.empty()) || (!last && !to.empty()) || (!first && !last)) return {};
  if (!first) {  // so many at the end
    const std::uint64_t bytes = std::min(*last, size);
    return bytes == 0 ? AskedRange{AskedRange::Is::kBeyond}
                      : AskedRange{AskedRange::Is::kPart, size - bytes, bytes};
  }
  if (last && *last < *first) return {};
  if (*first >= size) return {AskedRange::Is::kBeyond};
  const std::uint64_t most = size - *first;
  return {AskedRange::Is::kPart, *first, last ? std::min(*last - *first, most - 1) + 1 : most};
}

}  // namespace weft::app
