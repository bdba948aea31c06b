// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "capture/devices.h"

namespace weft::app {

/// A camera that tells what it says of itself and which exposures it has, each time it is asked.
class WatchedCamera : public capture::Camera {
 public:
  using Told = std::function<void(const capture::CameraFacts&)>;

  using ToldTimes = std::function<void(const std::vector<double>&)>;

  WatchedCamera(capture::Camera& camera, Told told, ToldTimes told_times)
      : camera_(camera), told_(std::move(told)), told_times_(std::move(told_times)) {}

  Result<capture::CameraFacts> connect() override { return pass_on(camera_.connect()); }
  Result<capture::CameraFacts> set(const capture::ExposureSettings& exposure) override {
    return pass_on(camera_.set(exposure));
  }
  Result<std::vector<double>> shutter_times_us() override {
    Result<std::vector<double>> times = camera_.shutter_times_us();
    if (times) told_times_(*times);
    return times;
  }
  Result<capture::Photograph> take(const std::filesystem::path& file,
                                   const std::function<void()>& exposed) override {
    return camera_.take(file, exposed);
  }
  Result<std::string> look() override { return camera_.look(); }
  Result<void> stop_looking() override { return camera_.stop_looking(); }
  Result<capture::CameraFacts> recover() override { return pass_on(camera_.recover()); }

 private:
  Result<capture::CameraFacts> pass_on(Result<capture::CameraFacts> facts) {
    if (facts) told_(*facts);
    return facts;
  }

  capture::Camera& camera_;
  Told told_;
  ToldTimes told_times_;
};

}  // namespace weft::app
