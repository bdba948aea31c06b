// SPDX-License-Identifier: Apache-2.0
#include "core/solve.h"

namespace weft {

Result<Product> find_solve(const std::filesystem::path& session, const std::string& id) {
  return find_product(kSolveProduct, session / "solve", id);
}

std::vector<Product> list_solves(const std::filesystem::path& session) {
  return list_products(kSolveProduct, session / "solve");
}

}  // namespace weft
