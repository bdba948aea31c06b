// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "capture/devices.h"
#include "capture/rig_devices/rig_devices.h"
#include "core/base/result.h"

namespace weft::app {

/// Open devices in the hands of a person. One that fails is asked to recover once; where it does not,
/// broken() says why, and they are to be closed.
class AttendedDevices {
 public:
  explicit AttendedDevices(capture::RigDevices devices) : devices_(std::move(devices)) {}

  /// As Lamps::light(); asked again after a recovery.
  Result<double> light(const std::vector<int>& leds, double most_s);
  Result<void> go_dark();
  Result<std::vector<double>> can_light_s() { return devices_.lamps->can_light_s(); }

  /// The exposure of what is taken. The camera is not asked where it has it already.
  Result<void> set(const capture::ExposureSettings& exposure);
  /// As Camera::take(), dark from the moment that its shutter has closed.
  Result<capture::Photograph> take(const std::filesystem::path& file);
  /// As Camera::look().
  Result<std::string> look();
  void stop_looking() { static_cast<void>(devices_.camera->stop_looking()); }

  const std::optional<Error>& broken() const { return broken_; }
  /// For another user.
  capture::RigDevices release() && { return std::move(devices_); }

 private:
  void recover_camera();

  capture::RigDevices devices_;
  std::optional<capture::ExposureSettings> set_;  ///< none: not known
  std::optional<Error> broken_;
};

}  // namespace weft::app
