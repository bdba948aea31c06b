// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/server/http/client.h"
#include "app/server/rig_server.h"
#include "core/base/process.h"
#include "core/base/result.h"
#include "core/base/temporary_folder.h"
#include "virtual_rig/rig_process.h"

namespace weft::bench {

/// A virtual rig and the weft serve of it, in a temporary folder.
class ServedRig {
 public:
  /// `programs`: folder with weft, weft-camera and weft-virtual-rig.
  Result<void> start(const std::filesystem::path& programs, const std::filesystem::path& scene,
                     double megapixels);
  /// Starts weft serve, unless it runs. kTryAgain with what it said where it does not come up.
  Result<void> serve();
  /// SIGKILL.
  void kill_daemon();

  const app::RigClient& client() const { return *client_; }
  int port() const { return port_; }
  const virtual_rig::RigProcess& rig() const { return *rig_; }

 private:
  TemporaryFolder folder_;
  std::unique_ptr<virtual_rig::RigProcess> rig_;
  std::unique_ptr<ChildProcess> daemon_;
  std::optional<app::RigClient> client_;
  int port_ = 0;
};

/// A server of sessions alone, at any free port. Errors of RigServer::start().
Result<std::unique_ptr<app::RigServer>> server_without_devices(const std::string& rig,
                                                               const std::filesystem::path& sessions,
                                                               const std::filesystem::path& state);

}  // namespace weft::bench
