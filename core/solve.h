// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/product.h"
#include "core/result.h"

// A solve: the maps that one run of the solver left in <session>/solve/<id>/ (docs/formats.md).

namespace weft {

inline constexpr ProductKind kSolveProduct = {"weft.solve", "solve.json", "solve",
                                              "solve the session first with weft solve"};

/// The complete solve of a session that has this id; without an id the newest. kNoInput where there is none.
Result<Product> find_solve(const std::filesystem::path& session, const std::string& id = "");

/// The complete solves of a session, the oldest first.
std::vector<Product> list_solves(const std::filesystem::path& session);

}  // namespace weft
