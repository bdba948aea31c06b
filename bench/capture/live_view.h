// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/report.h"
#include "capture/rig.h"
#include "capture/rig_devices/rig_devices.h"
#include "core/result.h"

namespace weft::bench {

struct LiveViewOptions {
  capture::Rig rig;
  capture::OpenDevices open;
  int rounds = 5;
  double looks_s = 3;  ///< of each round
  double exposure_us = 20000;
};

/// How soon and how often a camera's finder shows something through CameraLink, and that a photograph between
/// two rounds costs what it costs without. Rows: "first picture" (seconds, the longest of the rounds),
/// "pictures"
/// ("a_second", over all rounds), "photograph after live view" and "photograph" (seconds, medians); "asked"
/// is what is asked for.
Result<Rows> capture_live_view_table(const LiveViewOptions& options);

}  // namespace weft::bench
