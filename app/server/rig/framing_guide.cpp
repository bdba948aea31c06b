// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/framing_guide.h"

#include <utility>

namespace weft::app {

/// Read once: a calibration never changes.
Result<calibration::KnownFrame> FramingGuide::frame() {
  const std::filesystem::path calibration = capture::calibration_now(rig_);
  if (calibration.empty()) {
    return Error{ErrorKind::kNoInput, "nothing is known of the frame", rig_.name,
                 "the rig has no calibration", "measure it: weft calibrate all"};
  }
  const std::lock_guard lock(mutex_);
  if (known_ && calibration_ == calibration) return *known_;
  Result<calibration::KnownFrame> known = calibration::known_frame(calibration);
  if (!known) return known;
  calibration_ = calibration;
  known_ = *known;
  return known;
}

Result<Json> FramingGuide::known() {
  const Result<calibration::KnownFrame> known = frame();
  return known ? Result<Json>(json_of(*known)) : known.error();
}

Result<Json> FramingGuide::seen(const std::string& jpeg, const calibration::AimedThing& aim) {
  const Result<calibration::KnownFrame> known = frame();
  const Result<calibration::SeenFrame> seen = calibration::seen_frame(
      jpeg, known ? std::optional(*known) : std::optional<calibration::KnownFrame>(), aim);
  return seen ? Result<Json>(json_of(*seen)) : seen.error();
}

}  // namespace weft::app
