// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "app/server/rig_server.h"
#include "core/result.h"

namespace weft::bench {

/// A server of sessions alone, at any free port. Errors of RigServer::start().
Result<std::unique_ptr<app::RigServer>> server_without_devices(const std::string& rig,
                                                               const std::filesystem::path& sessions,
                                                               const std::filesystem::path& state);

}  // namespace weft::bench
