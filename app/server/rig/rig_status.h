// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capture/devices.h"
#include "capture/rig.h"
#include "capture/scan/scan.h"
#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::app {

/// How the lit shot of one LED stands.
struct LedStatus {
  enum class State { kWaiting, kExposing, kChecking, kKept, kRefused };

  int led = 0;
  State state = State::kWaiting;
  int takes = 0;                  ///< photographs so far
  capture::FrameFinding finding;  ///< of the last one
  double clipped = 0;             ///< share of its worst channel
};

/// How a rig is, and how far its scan has come.
struct RigStatus {
  enum class State { kIdle, kAttended, kConnecting, kScanning, kPaused, kFailed };

  State state = State::kIdle;
  std::string session;                ///< being scanned, or scanned last; empty: none yet
  capture::ScanStatus scan;           ///< where the session's scan stands
  std::optional<Error> error;         ///< why that scan failed
  std::vector<std::string> warnings;  ///< that it ended with
  std::vector<LedStatus> leds;        ///< the scan's LEDs, in the order of its plan
  std::optional<double> left_s;       ///< of a scan that runs, once two frames were kept
  bool can_go_on = false;             ///< what failed or was cancelled can be begun again
  std::vector<double> can_light_s;    ///< Attendance::Status
  bool devices_open = false;
  bool is_dark = false;             ///< screens that the cloth sees are to be black
  std::optional<double> dark_in_s;  ///< they will be, and not sooner; none where it is not announced
  std::vector<int> lit;             ///< for a person to see by; a scan's own is scan.led
  std::string controls;             ///< who holds them; empty: nobody
  std::string by;                   ///< who began the scan, or the last one; empty: not known
  std::optional<capture::CameraFacts> camera;  ///< what it said of itself during that scan
  std::vector<double> exposures_us;            ///< Attendance::Status
  Json place;                                  ///< RigWatch::place()
};

/// {"rig", "state", "phase", "session", "led", "frames", "frames_planned", "exposure_us", "why", "error",
/// "warnings", "leds", "left_s", "can", "dark", "dark_in_s", "lit", "controls", "by", "place", "devices"}, as
/// docs/http.md says.
Json to_json(const RigStatus& status, const capture::Rig& rig);

}  // namespace weft::app
