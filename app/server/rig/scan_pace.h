// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>

#include "capture/scan/scan.h"

namespace weft::app {

/// How fast a scan goes, by the frames that it has kept: the time in which it waits for a person or a device
/// does not count.
class ScanPace {
 public:
  using Time = std::chrono::steady_clock::time_point;

  void follow(const capture::ScanStatus& status, Time now = std::chrono::steady_clock::now());

  /// Seconds a shot; none before two frames were kept.
  std::optional<double> shot_s() const;
  /// Seconds to its end. They rise only where there is more to be done than before.
  std::optional<double> left_s() const { return left_s_; }

 private:
  std::optional<Time> before_;  ///< when it was last told
  bool waits_ = false;
  bool has_begun_ = false;
  double worked_s_ = 0;  ///< since the first shot began
  double kept_s_ = 0;    ///< worked_s_ when the last frame was kept
  int shots_ = 0;        ///< kept in that time
  int frames_ = 0;
  std::optional<double> left_s_;
};

}  // namespace weft::app
