// SPDX-License-Identifier: Apache-2.0
// The steps that measure a part of a rig.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "app/cli/calibrate.h"
#include "app/cli/described_options.h"
#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "calibration/run/calibrate_camera.h"
#include "calibration/run/calibrate_color.h"
#include "calibration/run/calibrate_grey.h"
#include "calibration/run/calibrate_lights.h"
#include "calibration/run/calibrate_response.h"
#include "calibration/run/poses_price.h"
#include "core/describe/field_json.h"

namespace weft::app {
namespace {

void print_poses(const calibration::PosesPrices& prices) {
  const bool is_camera = prices.thing == "board";
  print(fmt::format("{:>5} {:>5}  {:>8}  {}  {:>6}  {:>6}", "poses", "more", "degrees",
                    is_camera ? "focal %  place mm" : "LED mm", "at rig", "fit s"));
  for (const calibration::PosesPrice& row : prices.rows) {
    const std::string sigma = is_camera ? fmt::format("{:>7.3g}  {:>8.3g}", *row.focal_percent, *row.place_mm)
                                        : fmt::format("{:>6.2g}", *row.position_mm);
    print(fmt::format("{:>5} {:>+5}  {:>8.3g}  {}  {:>4.0f} s  {:>6.2g}{}", row.poses, row.more,
                      row.predicted_deg, sigma, row.rig_s, row.fit_s,
                      !row.is_chosen  ? ""
                      : row.more == 0 ? "  <- what is there suffices"
                                      : "  <- to take"));
  }
  print(fmt::format(
      "degrees: what its errors turn a normal by; at rig: {:g} s for laying the {}, and its photographs",
      calibration::kLaying_s, prices.thing));
}

// A step with the options that its job describes.
template <typename StepOptions,
          Result<calibration::CalibrateOutcome> (*kStep)(const StepOptions&, const JobContext&)>
Run add_step(Options& options) {
  const auto a = std::make_shared<StepOptions>();
  add_options(options, *a);
  return run_step(options, [a](const JobContext& context) { return kStep(*a, context); });
}

// The same of a step that can say what more photographs would buy.
template <typename StepOptions, auto kStep,
          Result<calibration::PosesPrices> (*kPrice)(const StepOptions&, const JobContext&)>
Run add_priced_step(Options& options) {
  const auto a = std::make_shared<StepOptions>();
  add_options(options, *a);
  const Run run = run_step(options, [a](const JobContext& context) { return kStep(*a, context); });
  return [a, run](const CommonArguments& common) -> Result<int> {
    if (!a->wish.only_explains) return run(common);
    const Result<calibration::PosesPrices> prices = [&] {
      ProgressLine line(common.quiet);
      return kPrice(*a, {common.threads, stop_on_signal(), line.callback()});
    }();
    if (!prices) return prices.error();
    common.json ? print_json(object_of(*prices)) : print_poses(*prices);
    return kDone;
  };
}

}  // namespace

Verb calibrate_camera_verb() {
  return {"camera", "Lens and pose from photographs of a checkerboard or ChArUco board",
          add_priced_step<calibration::CalibrateCameraOptions, calibration::calibrate_camera,
                          calibration::price_camera>};
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
          add_priced_step<calibration::CalibrateLightsOptions, calibration::calibrate_lights,
                          calibration::price_lights>};
}

Verb calibrate_grey_verb() {
  return {"grey",
          "How bright each LED is by channel, and its white balance, from a grey scale of known reflectances",
          add_step<calibration::CalibrateGreyOptions, calibration::calibrate_grey>};
}

}  // namespace weft::app
