// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "capture/framing/focus.h"
#include "capture/rig.h"
#include "capture/scan/light_fit.h"
#include "capture/scan/meter.h"
#include "core/image/raw_frame.h"
#include "core/rig/calibration.h"

namespace weft::app {

/// What the frame of a test shot says.
struct ShotReading {
  Size size = {};
  capture::FocusStanding focus;  ///< in its series
  std::optional<double>
      suggested_us;  ///< what the meter of a scan comes to; none without a LED, or if it fails
};

/// Reads the frames of test shots. Those of one LED at one exposure, one after another, are a series: one
/// turn of the focus ring, of one cloth.
class ShotReader {
 public:
  explicit ShotReader(const capture::Rig& rig) : rig_(rig) {}

  /// What is read from here on is read by this one, as far as it goes.
  void calibrate(const Calibration& calibration);

  /// Reads a frame by this LED (0: none). `exposures_us` are the camera's. One that is full or too dark is
  /// metered by shots of the meter's own, which `shoot` takes: once in a series of frames that look alike.
  ShotReading read(const RawFrame& frame, int led, double exposure_us,
                   const std::vector<double>& exposures_us, const capture::TestShot& shoot);

 private:
  std::optional<double> suggested_us(const capture::MeteredShot& shot,
                                     const std::vector<double>& exposures_us, const capture::TestShot& shoot);

  struct Metered {
    capture::Brightness seen;  ///< of the frame that did not tell
    double exposure_us = 0;    ///< by the meter's own shots
  };
  struct Series {
    int led = -1;
    double exposure_us = 0;
    capture::FocusSeries focus;
    std::optional<Metered> metered;
  };

  const capture::Rig& rig_;
  std::optional<capture::PhotositeNoise> noise_;
  std::optional<capture::PatchLights> lights_;
  Series series_;
};

}  // namespace weft::app
