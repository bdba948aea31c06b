// SPDX-License-Identifier: Apache-2.0
#include "bench/server/no_devices.h"

namespace weft::bench {

Result<std::unique_ptr<app::RigServer>> server_without_devices(const std::string& name,
                                                               const std::filesystem::path& sessions,
                                                               const std::filesystem::path& state) {
  capture::Rig rig;
  rig.name = name;
  rig.scan.sessions = sessions;
  rig.daemon.port = 0;
  rig.daemon.state = state;
  const Error no_devices = {ErrorKind::kTryAgain, "this rig has no devices", rig.name, "", "name another"};
  return app::RigServer::start(
      rig, [=](const capture::Rig&) -> Result<capture::RigDevices> { return no_devices; },
      [=](const capture::ScanRequest&, capture::Lamps&, capture::Camera&, const capture::ScanEvents&,
          const capture::ScanControl&) -> Result<capture::ScanOutcome> { return no_devices; });
}

}  // namespace weft::bench
