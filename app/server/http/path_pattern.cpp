// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/path_pattern.h"

namespace weft::app {

std::optional<std::vector<std::string>> segments_in(std::string_view pattern, std::string_view path) {
  std::vector<std::string> segments;
  while (!pattern.empty() && !path.empty()) {
    const std::string_view wanted = pattern.substr(0, pattern.find('/', 1));
    const std::string_view is = path.substr(0, path.find('/', 1));
    const bool takes_any = wanted.starts_with("/{");
    if (takes_any ? is.size() < 2 : wanted != is) return std::nullopt;
    if (takes_any) segments.emplace_back(is.substr(1));
    pattern.remove_prefix(wanted.size());
    path.remove_prefix(is.size());
  }
  if (!pattern.empty() || !path.empty()) return std::nullopt;
  return segments;
}

}  // namespace weft::app
