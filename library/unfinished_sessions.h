// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/session.h"

namespace weft::library {

struct UnfinishedSession {
  std::filesystem::file_time_type written;
  std::string name;
  Session session;
};

/// The sessions in a folder that a scan of this cloth on this rig could finish, the newest first. What cannot
/// be read is left out.
std::vector<UnfinishedSession> unfinished_sessions(const std::filesystem::path& sessions,
                                                   const std::string& rig, const std::string& fabric);

}  // namespace weft::library
