// SPDX-License-Identifier: Apache-2.0
// The steps that measure a part of a rig.
#include <memory>
#include <string>
#include <vector>

#include "app/cli/calibrate.h"
#include "app/cli/described_options.h"
#include "calibration/run/calibrate_camera.h"
#include "calibration/run/calibrate_color.h"
#include "calibration/run/calibrate_grey.h"
#include "calibration/run/calibrate_lights.h"
#include "calibration/run/calibrate_response.h"

namespace weft::app {
namespace {

// A step with the options that its job describes.
template <typename StepOptions,
          Result<calibration::CalibrateOutcome> (*kStep)(const StepOptions&, const JobContext&)>
Run add_step(Options& options) {
  const auto a = std::make_shared<StepOptions>();
  add_options(options, *a);
  return run_step(options, [a](const JobContext& context) { return kStep(*a, context); });
}

}  // namespace

Verb calibrate_camera_verb() {
  return {"camera", "Lens and pose from photographs of a checkerboard or ChArUco board",
          add_step<calibration::CalibrateCameraOptions, calibration::calibrate_camera>};
}

Verb calibrate_response_verb() {
  return {"response", "What counts say of light: noise, black level, linearity, bad photosites",
          add_step<calibration::CalibrateResponseOptions, calibration::calibrate_response>};
}

Verb calibrate_color_verb() {
  return {"color", "From the camera's channels to linear Rec.709, by a 24-patch chart",
          add_step<calibration::CalibrateColorOptions, calibration::calibrate_color>};
}

Verb calibrate_lights_verb() {
  return {"lights", "Where the LEDs are and how they shine, from white paper in five or more poses",
          add_step<calibration::CalibrateLightsOptions, calibration::calibrate_lights>};
}

Verb calibrate_grey_verb() {
  return {"grey",
          "How bright each LED is by channel, and its white balance, from a grey scale of known reflectances",
          add_step<calibration::CalibrateGreyOptions, calibration::calibrate_grey>};
}

}  // namespace weft::app
