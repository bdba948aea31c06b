// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/path_pattern.h"

namespace weft::app {

bool fits(std::string_view pattern, std::string_view path) {
  while (!pattern.empty() && !path.empty()) {
    const std::string_view wanted = pattern.substr(0, pattern.find('/', 1));
    const std::string_view is = path.substr(0, path.find('/', 1));
    if (!wanted.starts_with("/{") && wanted != is) return false;
    pattern.remove_prefix(wanted.size());
    path.remove_prefix(is.size());
  }
  return pattern.empty() && path.empty();
}

}  // namespace weft::app
