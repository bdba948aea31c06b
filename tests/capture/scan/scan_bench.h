// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "capture/scan/scan.h"
#include "tests/capture/scan/simulated_rig.h"

namespace weft::test {

/// A simulated rig with its calibration and a request for a session, in a fresh folder of the running test.
struct ScanBench {
  ScanBench();
  Result<capture::ScanOutcome> scan();
  /// What is wrong with the session: a frame that is not what an undisturbed scan would have got, a file too
  /// many. Empty where all is right.
  std::string objection() const;

  std::filesystem::path folder;
  SimulatedRig rig;
  capture::ScanRequest request;
  capture::ScanControl control;
  capture::ScanOptions options = {.device_patience_s = 5, .tries_per_shot = 3};
  std::vector<capture::KeptFrame> kept;
  std::vector<capture::RefusedFrame> refused;
  std::vector<capture::ScanStatus> statuses;
  std::function<void(const capture::ScanStatus&)> on_status = [](const capture::ScanStatus&) {};
};

}  // namespace weft::test
