// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "core/json_document.h"
#include "core/result.h"
#include "core/session.h"

namespace weft::library {

/// A raw frame on disk and the digest that names it.
struct StoredFrame {
  std::filesystem::path file;
  std::string sha256;
};

/// The sessions in one folder, as clients see them. Files are read again only when they have changed. Safe
/// from any thread.
class SessionCatalog {
 public:
  SessionCatalog(std::filesystem::path sessions, std::string rig);

  /// Newest first: [{"name", "state", "resumable", "frames", "fabric", "rig", "written", "error"}]; `state`
  /// is "unreadable" where session.json is, and then `error` says why.
  Json list();
  /// The names of the unfinished ones of this rig.
  Json resumable();
  /// kUsage for what is no name, kNoInput where there is no such session.
  Result<Session> find(const std::string& name) const;
  /// The file of one frame, which lies in the session. kUsage, kNoInput.
  Result<StoredFrame> frame(const std::string& name, const std::string& index) const;
  /// Whether a scan of this rig could finish it.
  bool is_resumable(const Session& session) const {
    return session.rig == rig_ && session.state != "complete";
  }

 private:
  struct Known {
    std::filesystem::file_time_type written;
    Json summary;
  };
  Json summary_of(const std::string& name, const std::filesystem::path& folder) const;

  std::filesystem::path sessions_;
  std::string rig_;
  std::mutex mutex_;
  std::map<std::string, Known> known_;
};

/// "lit", as in session.json.
const char* name_of(ShotRole role);

/// Whether a file is really there: a link in a session could lead out of it.
bool lies_in(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace weft::library
