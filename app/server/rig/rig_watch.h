// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "calibration/run/rig_look.h"
#include "capture/rig.h"
#include "core/base/json_document.h"

namespace weft::app {

/// How a rig is by the last scan that was looked at (calibration/run/rig_look.h), against the calibration
/// that it has now. Safe from any thread; what is read is read on a thread of its own, so that who tells it
/// of something may hold what `told` waits for.
class RigWatch {
 public:
  /// Begins with the look that lies in the rig's sessions and was written last. `told` is called where
  /// place() is another one, with nothing held.
  RigWatch(capture::Rig rig, std::function<void()> told);

  /// A session was looked at.
  void saw(const std::filesystem::path& session);
  /// The rig may have another calibration now.
  void hold_against_calibration();
  /// Tells nothing from here on.
  void stop();

  /// {"state", "says", "action", "cost_mean_deg", "session", "taken"}; null where no scan was looked at.
  Json place() const;

 private:
  void work(const std::stop_token& stop);
  void look_at(const std::filesystem::path& session);

  const capture::Rig rig_;
  const std::function<void()> told_;
  mutable std::mutex mutex_;  ///< of all that follows
  std::condition_variable_any woken_;
  std::deque<std::filesystem::path> to_see_;  ///< empty: by another calibration

  std::string session_;                       ///< its name
  std::optional<calibration::RigLook> seen_;  ///< by the calibration of now
  std::jthread thread_;
};

}  // namespace weft::app
