// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct CaptureCameraBenchOptions {
  std::string port;  ///< of a running camera: "ptpip:127.0.0.1:15740:15740"
  std::string profile = "nikon-d5100";
  double exposure_us = 1e6 / 60;
  int shots = 10;  ///< a round of each loop
  int rounds = 3;
  std::filesystem::path folder = {};  ///< on the disk that photographs go to; empty: a temporary one
};

/// Seconds of each turn of a bare loop of trigger, wait_for_event and file_get, `shots` of them.
Result<std::vector<double>> bare_shots_s(const CaptureCameraBenchOptions& options);

/// What a photograph through CameraLink costs, in its file, synced, summed up and proved to be the one asked
/// for, against a bare loop of trigger, wait_for_event and file_get through the same libgphoto2 and camera.
/// The loops take turns. Medians over all shots: `seconds` a shot, `ratio` to the bare loop; `bar` is what is
/// asked for.
Result<Rows> capture_camera_table(const CaptureCameraBenchOptions& options);

}  // namespace weft::bench
