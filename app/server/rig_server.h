// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "app/server/http/http_server.h"
#include "app/server/rig/logbook.h"
#include "app/server/rig/rig_keeper.h"
#include "capture/rig.h"
#include "core/base/result.h"

namespace weft::app {

/// How a server is run, beside what the rig file says.
struct RigServerOptions {
  HttpLimits limits = {};
  /// Where the rig file names no token, the server makes one that clients of this user can read.
  bool own_token = false;
  std::filesystem::path weft = {};  ///< the program that jobs run; empty: weft beside this one
  bool looks = false;     ///< a finished scan is held against its calibration, as the first of the jobs
  bool previews = false;  ///< then it is solved once quickly
  Logbook::Say say = {};  ///< hears each line of its log; empty: nobody does
};

/// One rig behind HTTP (docs/http.md): its lock, its scan, its sessions. Run by weft serve for as long as the
/// machine is up, and by weft scan within its own process where no daemon is.
class RigServer {
 public:
  /// Takes the rig's lock, listens at rig.daemon.host and port, leaves its address in the state folder and
  /// writes what happens to log/ in there. Errors: kTryAgain (another process owns the rig, or the port is in
  /// use), kUsage (open to the network without a token), kBadData (a bad token file), kCannotCreate.
  static Result<std::unique_ptr<RigServer>> start(const capture::Rig& rig, capture::OpenDevices open,
                                                  RunScan run, const RigServerOptions& options = {});
  /// Waits for a running scan to end.
  ~RigServer();

  int port() const;
  const std::string& address() const;  ///< "http://127.0.0.1:8470"
  const std::string& token() const;    ///< that clients must send; empty: none
  /// Every "METHOD path" there is.
  std::vector<std::string> calls() const;

  /// Cancels the scan (lights off, session resumable), ends all connections. False if the scan has not ended
  /// in this time: its board turns the lights off by itself once this process is gone.
  bool stop(std::chrono::milliseconds most = std::chrono::milliseconds(2300));

 private:
  struct State;
  explicit RigServer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace weft::app
