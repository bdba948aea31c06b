// SPDX-License-Identifier: Apache-2.0
#include "library/catalogue/prune.h"

#include <algorithm>
#include <cerrno>
#include <utility>

#include "core/base/files.h"
#include "core/base/json_document.h"
#include "core/solve/solve.h"
#include "library/catalogue/session_files.h"
#include "solve/session/current.h"
#include "solve/session/session_lock.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

// Rectified maps of a solve.
std::vector<fs::path> made_from(const fs::path& session, const std::string& solve) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(session / "rectified", error)) {
    const Result<Json> document = read_json(entry.path() / "rectify.json", "weft.rectified", 1);
    if (document && document->value("solve", Json()) == solve) folders.push_back(entry.path());
  }
  return folders;
}

}  // namespace

Result<std::vector<Prunable>> prunable(const fs::path& folder, int keep) {
  const Result<Session> session = read_session(folder);
  if (!session) return session.error();
  const std::string current = solve::current_solve(*session);
  std::vector<Product> solves = list_solves(folder);
  const std::size_t newest = std::min(solves.size(), static_cast<std::size_t>(std::max(keep, 0)));
  solves.resize(solves.size() - newest);
  std::vector<Prunable> found;
  for (const Product& solve : solves) {
    if (solve.id == current) continue;
    Prunable one = {solve.id, made_from(folder, solve.id), 0};
    one.folders.push_back(solve.folder);
    for (const fs::path& each : one.folders) one.bytes += bytes_below(each);
    found.push_back(std::move(one));
  }
  return found;
}

Result<void> prune(const fs::path& folder, const std::vector<Prunable>& solves) {
  const Result<Descriptor> lock = solve::lock_session(folder);
  if (!lock) return lock.error();
  for (const Prunable& solve : solves) {
    for (const fs::path& each : solve.folders) {
      const fs::path aside = each.parent_path() / ("." + each.filename().string() + ".pruned");
      std::error_code error;
      fs::rename(each, aside, error);
      if (!error) fs::remove_all(aside, error);
      if (error) return cannot_write(each, error.value());
    }
  }
  return {};
}

}  // namespace weft::library
