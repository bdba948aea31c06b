// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "calibration/guide/framing.h"
#include "capture/rig.h"
#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::app {

/// What a person lays a cloth or a board by, at a rig. Safe from any thread.
class FramingGuide {
 public:
  explicit FramingGuide(const capture::Rig& rig) : rig_(rig) {}

  /// What the rig's calibration knows of the frame. kNoInput where the rig has none; those of known_frame().
  Result<Json> known();
  /// What this picture of the finder shows.
  Result<Json> seen(const std::string& jpeg, const calibration::AimedThing& aim);

 private:
  Result<calibration::KnownFrame> frame();

  const capture::Rig& rig_;
  std::mutex mutex_;
  std::filesystem::path calibration_;  ///< of known_
  std::optional<calibration::KnownFrame> known_;
};

}  // namespace weft::app
