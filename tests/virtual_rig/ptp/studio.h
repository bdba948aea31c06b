// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "virtual_rig/ptp/virtual_camera.h"

namespace weft::virtual_rig {

/// A virtual camera whose pictures are noise that begins with the picture's number, and what it developed.
class Studio {
 public:
  static constexpr std::size_t kFileBytes = 100'001;

  explicit Studio(VirtualCameraOptions options = {}, std::size_t bytes = kFileBytes) : bytes_(bytes) {
    options.size = {640, 480};
    auto started = VirtualCamera::start(
        options, [this](const CameraExposure& exposure) -> Result<std::vector<std::uint8_t>> {
          return develop(exposure);
        });
    if (started)
      camera_ = *std::move(started);
    else
      ADD_FAILURE() << started.error().message();
  }
  ~Studio() { camera_.reset(); }

  VirtualCamera& camera() { return *camera_; }
  std::string network() const {
    const std::string port = std::to_string(camera_->port());
    return "ptpip:127.0.0.1:" + port + ":" + port;
  }
  void inject(const char* name, int shot = 1) {
    const Result<void> injected = camera_->inject({name, shot});
    EXPECT_TRUE(injected) << injected.error().message();
  }
  /// Which picture a file is; 0 for none that was developed.
  std::uint32_t number_of(const std::vector<std::uint8_t>& file) {
    const std::lock_guard lock(mutex_);
    for (const auto& [number, developed] : files_)
      if (developed == file) return number;
    return 0;
  }
  std::vector<CameraExposure> exposures() {
    const std::lock_guard lock(mutex_);
    return exposures_;
  }

 private:
  std::vector<std::uint8_t> develop(const CameraExposure& exposure) {
    std::vector<std::uint8_t> file(bytes_);
    std::uint64_t state = exposure.image_number;
    for (std::size_t i = 0; i < file.size(); i += 4096) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      file[i] = static_cast<std::uint8_t>(state >> 56);
    }
    file[0] = static_cast<std::uint8_t>(exposure.image_number);
    const std::lock_guard lock(mutex_);
    exposures_.push_back(exposure);
    if (bytes_ < 1'000'000) files_[exposure.image_number] = file;
    return file;
  }

  const std::size_t bytes_;
  std::mutex mutex_;
  std::map<std::uint32_t, std::vector<std::uint8_t>> files_;
  std::vector<CameraExposure> exposures_;
  std::unique_ptr<VirtualCamera> camera_;
};

}  // namespace weft::virtual_rig
