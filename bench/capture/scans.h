// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <stop_token>

#include "bench/base/report.h"
#include "capture/rig.h"
#include "capture/rig_devices/rig_devices.h"
#include "core/result.h"

namespace weft::bench {

struct ScansOptions {
  capture::Rig rig;
  capture::OpenDevices open;
  int scans = 1;
  double exposure_us = 20000;
  std::stop_token stop = {};
  std::function<void(int done)> progress = [](int) {};
};

/// Scans the same cloth again and again, each time with the devices opened anew, looks whether every frame
/// shows what it showed in the first scan (so the rig's noise must depend on the light alone), and removes
/// the session. Rows, at about ten points along the way: scans, seconds a scan (least, median) and the median
/// over as many turns of a bare loop as a scan has frames, measured before; memory and open descriptors of
/// this process and of weft-camera; frames that differ.
Result<Rows> capture_scans_table(const ScansOptions& options);

}  // namespace weft::bench
