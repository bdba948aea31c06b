// SPDX-License-Identifier: Apache-2.0
#include "library/current.h"

#include <algorithm>
#include <vector>

namespace weft::library {

std::string current_solve(const Session& session) {
  const std::vector<Product> solves = list_solves(session.folder);
  if (solves.empty()) return "";
  const auto named = session.document.find("current_solve");
  if (named != session.document.end() && named->is_string()) {
    const auto found = std::ranges::find(solves, named->get_ref<const std::string&>(), &Product::id);
    if (found != solves.end()) return found->id;
  }
  return solves.front().id;
}

}  // namespace weft::library
