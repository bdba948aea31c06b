// SPDX-License-Identifier: Apache-2.0
#include "calibration/suits.h"

#include <fmt/format.h>

namespace weft::calibration {
namespace {

Error differs(const Session& session, std::string why) {
  return {ErrorKind::kBadData, "calibration does not suit the session", session.folder.string(),
          std::move(why),
          "name the calibration of this rig with --calibration, or calibrate the rig as it is now"};
}

}  // namespace

Result<void> suits(const Calibration& calibration, const Session& session, const ShotMetadata& frame) {
  const CalibrationSubject& subject = calibration.subject;
  if (subject.rig != session.rig) {
    return differs(session,
                   fmt::format("it is of rig \"{}\", the session of \"{}\"", subject.rig, session.rig));
  }
  if (!frame.model.empty() && frame.model != subject.camera_model) {
    return differs(session,
                   fmt::format("it is of a {}, the frames of a {}", subject.camera_model, frame.model));
  }
  if (!frame.serial.empty() && !subject.camera_serial.empty() && frame.serial != subject.camera_serial) {
    return differs(session, fmt::format("it is of the body with serial number {}, the frames of {}",
                                        subject.camera_serial, frame.serial));
  }
  for (const Shot& shot : session.shots) {
    if (shot.f_number != subject.f_number) {
      return differs(session, fmt::format("it holds at f/{}, {} was taken at f/{}", subject.f_number,
                                          shot.file, shot.f_number));
    }
    if (calibration.lights && shot.led > static_cast<int>(light_count(*calibration.lights))) {
      return differs(session, fmt::format("it measures {} LEDs, {} lit LED {}",
                                          light_count(*calibration.lights), shot.file, shot.led));
    }
  }
  if (!calibration.lights || !calibration.camera || !calibration.response) {
    return differs(session, fmt::format("it has no {}", !calibration.lights   ? "lights.json"
                                                        : !calibration.camera ? "camera.json"
                                                                              : "response.json"));
  }
  return {};
}

}  // namespace weft::calibration
