// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/server/rig/frame_pictures.h"
#include "app/server/rig/shot_reading.h"
#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::app {

/// A photograph that a person looks at and nobody keeps.
struct TestShot {
  int id = 0;
  int led = 0;                         ///< 0: none was lit
  double exposure_us = 0;              ///< of the camera's own
  std::optional<FrameFile> frame;      ///< once it is taken
  std::optional<ShotReading> reading;  ///< of the frame; none where it cannot be decoded
  std::optional<Error> error;          ///< why there is no frame
};

/// "shot000042": how the file of a test shot begins.
std::string stem_of_shot(int id);

/// The last test shots, one of which is taken at a time.
class TestShots {
 public:
  static constexpr std::size_t kKept = 8;

  /// The next one, whose id is one more than that of the last.
  TestShot begin(int led, double exposure_us);
  /// What became of the one that was begun last. Gives the files of those that are kept no longer.
  std::vector<std::filesystem::path> end(TestShot shot);
  /// kNoInput where it is none of those that are kept.
  Result<TestShot> find(int id) const;

 private:
  std::deque<TestShot> shots_;
  int newest_ = 0;
};

/// {"id", "led", "exposure_us", "state" (taking, taken, failed), "width", "height", "suggested_us",
/// "clipped_rgb", "histogram", "focus", "error"}: the histogram of one that is taken is counted now, if it is
/// not yet.
Json document_of(const TestShot& shot, FramePictures& pictures);

}  // namespace weft::app
