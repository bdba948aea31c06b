// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/rig/scan_verdict.h"
#include "library/catalogue/database.h"
#include "library/catalogue/metadata.h"

// All sessions of some folders, to be listed and searched without opening them.

namespace weft::library {

/// What the catalogue knows of a session.
struct Entry {
  std::int64_t key = 0;          ///< its place in this catalogue, for paging
  std::filesystem::path folder;  ///< absolute, NAME.weft
  std::string name;
  std::string fabric, rig, calibration;
  std::string state;           ///< as session.json has it; "unreadable" where that cannot be read
  std::optional<Error> error;  ///< why it, or its metadata, cannot be read
  Metadata metadata;
  int shots = 0, solves = 0;
  int lit_shot = 0;                   ///< index of the first lit one that is used
  std::string lit_sha256;             ///< and its digest; empty where there is none
  std::string current_solve;          ///< id (solve/session/current.h); empty where there is no solve
  std::string taken;                  ///< ISO 8601, of the first shot, else when session.json was written
  std::string written;                ///< ISO 8601, when session.json was
  std::uint64_t bytes = 0;            ///< of its folder, when it was read
  std::vector<std::string> warnings;  ///< of its shots
  ScanVerdict verdict;                ///< library/catalogue/session_verdict.h
};

/// {"key", "name", "folder", "fabric", "id", "tags", ... "bytes", "warnings", "error"}; amounts that nobody
/// said are null, and so is `error` (core/describe/error_json.h) where there is none.
Json json_of(const Entry& entry);

/// What to look for. Empty fields ask for nothing.
struct Query {
  /// All of these must occur in name, fabric, tags, composition, notes or id, each as the beginning of a
  /// word, whatever its case and accents.
  std::string words = {};
  std::string id = {}, tag = {}, state = {}, fabric = {}, rig = {}, calibration = {};  ///< exactly
  std::string from = {}, before = {};      ///< ISO 8601, or its beginning: 2026-11
  bool unfinished = false;                 ///< only those that a scan could go on with
  bool warned = false;                     ///< only those whose verdict is not good
  std::filesystem::path in = {};           ///< the folder that they lie in, themselves and not below
  int limit = 100;                         ///< entries a page, 1 to 1000
  std::optional<std::int64_t> after = {};  ///< the key that ended the page before
};

struct CataloguePage {
  std::vector<Entry> entries;
  std::size_t total = 0;              ///< over all pages
  std::optional<std::int64_t> after;  ///< of the next page; none: this is the last
};

/// What refreshing found.
struct RefreshFacts {
  std::size_t sessions = 0, read = 0, removed = 0;
  std::vector<std::filesystem::path> unreachable;  ///< folders that cannot be listed: what was known stays
};

/// A SQLite file that can be thrown away: refresh() makes it again from the folders. Never on a disk that
/// several machines share. One object serves one thread; several objects and processes may use one file.
class Catalogue {
 public:
  /// Opens the file, and makes it if there is none. A file that is damaged, or of another version, is put
  /// aside (".damaged") and made anew: the next refresh() fills it. Errors of database.h.
  static Result<Catalogue> open(const std::filesystem::path& file);
  /// One more of the same file, for another thread.
  Result<Catalogue> beside() const;

  /// Looks through the folders and those below them for sessions, and reads those whose session.json or list
  /// of solves changed since. Links are not followed. What these folders no longer show is forgotten. Reads
  /// in parallel, and reports the phases "look" and "read".
  Result<RefreshFacts> refresh(const std::vector<std::filesystem::path>& folders, const JobContext& context);
  /// The same for one session, after it was changed.
  Result<void> refresh(const std::filesystem::path& session);
  /// Forgets all sessions that lie below none of these folders.
  Result<void> keep_only(const std::vector<std::filesystem::path>& folders);

  /// Newest first; of words the best match first, among the first 20 000. kUsage where limit or words cannot
  /// be used, or the entry `after` is gone.
  Result<CataloguePage> find(const Query& query);
  /// The session of this name, folder or id: kNoInput where there is none, kUsage where there are
  /// several.
  Result<Entry> find_one(const std::string& name);
  /// All tags with how many sessions have each, most first.
  Result<std::vector<std::pair<std::string, int>>> tags();

 private:
  explicit Catalogue(Database database) : database_(std::move(database)) {}
  Result<std::unordered_map<std::string, struct Found>> known(const std::string& folder);
  Result<bool> is_known(const struct Found& found);
  Result<void> put(std::span<const struct Found> found, std::span<const Entry> entries);
  Result<void> forget(const std::vector<std::string>& folders);
  Result<std::vector<std::int64_t>> keys_of(const Query& query);
  Result<Entry> entry(std::int64_t key);

  Database database_;
};

}  // namespace weft::library
