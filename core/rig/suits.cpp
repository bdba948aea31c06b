// SPDX-License-Identifier: Apache-2.0
#include "core/rig/suits.h"

#include <fmt/format.h>

#include "core/rig/same_camera.h"

namespace weft {
namespace {

Error differs(const Session& session, std::string why) {
  return {ErrorKind::kBadData, "calibration does not suit the session", session.folder.string(),
          std::move(why),
          "name the calibration of this rig with --calibration, or calibrate the rig as it is now"};
}

}  // namespace

std::optional<std::string> focal_difference(double frame_mm, double other_mm) {
  if (!(frame_mm > 0 && other_mm > 0) || same_setting(frame_mm, other_mm)) return {};
  return fmt::format("focal length {:.3g} mm, not {:.3g}: turn the zoom back or calibrate again", frame_mm,
                     other_mm);
}

std::optional<std::string> subject_difference(const CalibrationSubject& subject, const ShotMetadata& frame) {
  if (!frame.model.empty() && !subject.camera_model.empty() && frame.model != subject.camera_model) {
    return fmt::format("the calibration is of a {}, the frame of a {}", subject.camera_model, frame.model);
  }
  if (!same_serial(frame.serial, subject.camera_serial)) {
    return fmt::format("the calibration is of the body with serial number {}, the frame of {}",
                       subject.camera_serial, frame.serial);
  }
  if (frame.f_number > 0 && subject.f_number > 0 && !same_setting(frame.f_number, subject.f_number)) {
    return fmt::format("the calibration holds at f/{:.3g}, the frame was taken at f/{:.3g}", subject.f_number,
                       frame.f_number);
  }
  return focal_difference(frame.focal_mm, subject.focal_length_mm);
}

Result<void> suits(const Calibration& calibration, const Session& session, const ShotMetadata& frame) {
  const CalibrationSubject& subject = calibration.subject;
  if (subject.rig != session.rig) {
    return differs(session,
                   fmt::format("it is of rig \"{}\", the session of \"{}\"", subject.rig, session.rig));
  }
  if (const auto why = subject_difference(subject, frame)) return differs(session, *why);
  for (const Shot& shot : session.shots) {
    if (!same_setting(shot.f_number, subject.f_number)) {
      return differs(session, fmt::format("it holds at f/{:.3g}, {} was taken at f/{:.3g}", subject.f_number,
                                          shot.file, shot.f_number));
    }
    const auto iso = calibration.response ? calibration.response->iso : std::nullopt;
    if (iso && !same_setting(shot.iso, *iso)) {
      return differs(session, fmt::format("its response was measured at ISO {:g}, {} was taken at ISO {:g}",
                                          *iso, shot.file, shot.iso));
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

}  // namespace weft
