// SPDX-License-Identifier: Apache-2.0
#include "library/batch/session_list.h"

#include <algorithm>

#include "core/base/json_document.h"

namespace weft::library {
namespace {

constexpr std::string_view kEnding = ".weft", kBlanks = " \t\r";

std::string_view trimmed(std::string_view line) {
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  while (!line.empty() && kBlanks.find(line.back()) != std::string_view::npos) line.remove_suffix(1);
  return line;
}

void add_texts(const Json& list, const char* key, std::vector<std::string>& folders) {
  if (!list.is_array()) return;
  for (const Json& each : list) {
    const Json text = each.is_object() ? each.value(key, Json()) : each;
    if (text.is_string()) folders.push_back(text.get<std::string>());
  }
}

// The folder that a line names; empty: it is a heading.
std::string_view folder_in(std::string_view line) {
  line = trimmed(line);
  std::string_view bare = line;
  while (bare.size() > 1 && bare.ends_with('/')) bare.remove_suffix(1);
  if (bare.ends_with(kEnding)) return bare;
  for (std::size_t at = line.find(kEnding); at != std::string_view::npos; at = line.find(kEnding, at + 1)) {
    const std::size_t end = at + kEnding.size();
    if (kBlanks.find(line[end]) != std::string_view::npos) return line.substr(0, end);
  }
  return line.starts_with('/') || line.starts_with('.') ? bare : std::string_view();
}

}  // namespace

std::vector<std::string> sessions_of_text(std::string_view text) {
  std::vector<std::string> folders;
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_array()) {
    add_texts(json, "session", folders);
    return folders;
  }
  if (json.is_object()) {
    add_texts(json.value("sessions", Json()), "folder", folders);
    const Json numbers = json.value("numbers", Json());
    if (numbers.is_object()) add_texts(numbers.value("affected", Json()), "session", folders);
    return folders;
  }
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view folder = folder_in(text.substr(0, end));
    if (!folder.empty()) folders.emplace_back(folder);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return folders;
}

}  // namespace weft::library
