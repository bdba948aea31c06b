// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "app/daemon/frame_pictures.h"
#include "core/json_document.h"
#include "core/result.h"
#include "core/session.h"

namespace weft::app {

/// The sessions in one folder, as clients see them. Files are read again only when they have changed. Safe
/// from any thread.
class SessionCatalog {
 public:
  SessionCatalog(std::filesystem::path sessions, std::string rig, FramePictures& pictures);

  /// Newest first: [{"name", "state", "resumable", "frames", "fabric", "rig", "written", "error"}]; `state`
  /// is "unreadable" where session.json is, and then `error` says why.
  Json list();
  /// The names of the unfinished ones of this rig.
  Json resumable();
  /// kUsage for what is no name, kNoInput where there is no such session.
  Result<Session> find(const std::string& name) const;
  /// The session with its frames, and what is known of each without decoding it; what is not known yet is
  /// made in the background.
  Result<Json> describe(const std::string& name);
  /// The file of one frame, which lies in the session. kUsage, kNoInput.
  Result<FrameFile> frame(const std::string& name, const std::string& index) const;

 private:
  struct Known {
    std::filesystem::file_time_type written;
    Json summary;
  };
  bool is_resumable(const Session& session) const {
    return session.rig == rig_ && session.state != "complete";
  }
  Json summary_of(const std::string& name, const std::filesystem::path& folder) const;

  std::filesystem::path sessions_;
  std::string rig_;
  FramePictures& pictures_;
  std::mutex mutex_;
  std::map<std::string, Known> known_;
};

/// "lit", as in session.json.
const char* name_of(ShotRole role);

}  // namespace weft::app
