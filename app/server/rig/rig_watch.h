// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "calibration/run/rig_look.h"
#include "capture/rig.h"
#include "core/base/json_document.h"

namespace weft::app {

/// How a rig is by the last scan that was looked at (calibration/run/rig_look.h), against the calibration
/// that it has now. Safe from any thread.
class RigWatch {
 public:
  /// Begins with the look that lies in the rig's sessions and was written last.
  explicit RigWatch(capture::Rig rig);

  /// A session was looked at.
  void saw(const std::filesystem::path& session);
  /// The rig may have another calibration now.
  void hold_against_calibration();

  /// {"state", "says", "action", "cost_mean_deg", "session", "taken"}; null where no scan was looked at.
  Json place() const;

 private:
  void take(const std::string& session, calibration::RigLook look);

  const capture::Rig rig_;
  mutable std::mutex mutex_;
  std::string session_;                       ///< its name
  std::optional<calibration::RigLook> seen_;  ///< by the calibration of now
};

}  // namespace weft::app
