// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/base/result.h"
#include "core/image/compression.h"
#include "library/batch/plan.h"

// Solves of which only some maps are kept.

namespace weft::library {

/// Maps that can be kept by name.
inline constexpr std::array kMapNames = {"normal", "albedo", "sigma", "residual", "status"};

/// The id of a solve of which that is kept: its own where all is.
std::string lean_id(const std::string& solve, const BatchProduct& product);

Compression compression_of(const BatchProduct& product);

/// Makes a solve's folder hold what is kept: other maps go, normals become half floats, and solve.json says
/// so, with `id` for its id, `made_from` the whole solve's, `kept` and `half`.
Result<void> make_lean(const std::filesystem::path& solve, const BatchProduct& product,
                       const std::string& id);

}  // namespace weft::library
