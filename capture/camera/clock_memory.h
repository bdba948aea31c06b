// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "capture/camera/photograph_evidence.h"

namespace weft::capture {

/// A clock and the serial number of the camera it is of.
struct RememberedClock {
  std::string serial;
  CameraClock clock;
};

/// A camera's clock as it was watched within the last hour, kept in a file between connections, for watching
/// takes up to a second.
class ClockMemory {
 public:
  explicit ClockMemory(std::filesystem::path file) : file_(std::move(file)) {}

  /// Its uncertainty has grown by what two quartzes drift apart. Nothing where it is older than an hour, or
  /// this machine's clock was set back since.
  std::optional<RememberedClock> recall(double now_s) const;
  /// What cannot be kept is watched again.
  void keep(const RememberedClock& watched, double now_s) const;
  void forget() const;

 private:
  std::filesystem::path file_;
};

}  // namespace weft::capture
