// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capture/devices.h"
#include "capture/rig.h"
#include "capture/scan/scan.h"
#include "core/json_document.h"
#include "core/result.h"

namespace weft::app {

/// How a rig is, and how far its scan has come.
struct RigStatus {
  enum class State { kIdle, kAttended, kConnecting, kScanning, kPaused, kFailed };

  State state = State::kIdle;
  std::string session;                ///< being scanned, or scanned last; empty: none yet
  capture::ScanStatus scan;           ///< of that session
  std::optional<Error> error;         ///< why that scan failed
  std::vector<std::string> warnings;  ///< that it ended with
  bool devices_open = false;
  std::vector<int> lit;                        ///< for a person to see by; a scan's own is scan.led
  std::string controls;                        ///< who holds them; empty: nobody
  std::string by;                              ///< who began the scan, or the last one; empty: not known
  std::optional<capture::CameraFacts> camera;  ///< what it said of itself during that scan
};

/// {"rig", "state", "phase", "session", "led", "frames", "frames_planned", "exposure_us", "why", "error",
/// "warnings", "devices", "lit", "controls", "by"}, as docs/http.md says.
Json to_json(const RigStatus& status, const capture::Rig& rig);

}  // namespace weft::app
