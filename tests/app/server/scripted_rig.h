// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "app/server/rig_server.h"
#include "capture/rig.h"
#include "core/rig/session.h"

namespace weft::app {

/// A rig in a folder of its own whose scan does what a test says. The interface's own tests need moments that
/// no rig can be brought to hold still at, and states that no scan of a sound rig reaches; scans of real
/// devices over HTTP are in tests/system.
class ScriptedRig {
 public:
  explicit ScriptedRig(const std::string& name);
  ~ScriptedRig();

  capture::Rig rig;  ///< any free port of 127.0.0.1

  // The script, set before a scan begins.
  std::function<Result<void>()> devices = []() -> Result<void> { return {}; };             ///< opening them
  std::function<Result<void>(int frame)> before = [](int) -> Result<void> { return {}; };  ///< each shot
  std::function<void()> at_end = [] {};         ///< while it finishes
  std::optional<capture::RefusedFrame> refuse;  ///< told of before the first shot
  bool own_token = false;                       ///< of the server
  int frames = 4;                               ///< the dark one and a LED each

  Result<std::unique_ptr<RigServer>> start(const HttpLimits& limits = {});
  /// As start(), which must succeed.
  std::unique_ptr<RigServer> started(const HttpLimits& limits = {});
  std::filesystem::path session(const std::string& name) const {
    return rig.scan.sessions / (name + ".weft");
  }
  /// An unfinished session of this rig with one frame, as a killed scan leaves it.
  void leave_unfinished(const std::string& name) const;

 private:
  Result<capture::ScanOutcome> scan(const capture::ScanRequest& request, const capture::ScanEvents& events,
                                    const capture::ScanControl& control) const;
};

/// The documents of a file of JSON lines.
std::vector<Json> json_lines(const std::filesystem::path& file);

/// Asks for the rig's status until it is in this state, for 5 seconds; that status.
Json wait_for_state(int port, const std::string& state, const std::string& token = "");

/// A door through which a scan goes only when the test opens it.
class Gate {
 public:
  void open() {
    open_ = true;
    open_.notify_all();
  }
  void pass() const { open_.wait(false); }

 private:
  std::atomic<bool> open_ = false;
};

}  // namespace weft::app
