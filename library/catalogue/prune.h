// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace weft::library {

/// A solve that can go, with what was made from it.
struct Prunable {
  std::string solve;                           ///< id
  std::vector<std::filesystem::path> folders;  ///< its own, and the rectified maps of it
  std::uint64_t bytes = 0;
};

/// Solves of a session that are neither its current one (solve/session/current.h) nor among the `keep`
/// newest. All of them can be made again from the photographs, which are never among the folders. Errors of
/// read_session().
Result<std::vector<Prunable>> prunable(const std::filesystem::path& session, int keep);

/// Removes the folders: each is renamed aside first, so that no half of a solve is ever seen. kTryAgain where
/// the session is being written.
Result<void> prune(const std::filesystem::path& session, const std::vector<Prunable>& solves);

}  // namespace weft::library
