// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "app/jobs/calibrate/camera.h"
#include "app/jobs/calibrate/check.h"
#include "app/jobs/calibrate/color.h"
#include "app/jobs/calibrate/grey.h"
#include "app/jobs/calibrate/history.h"
#include "app/jobs/calibrate/lights.h"
#include "app/jobs/calibrate/patches.h"
#include "app/jobs/calibrate/response.h"
#include "app/jobs/calibrate/update.h"

namespace CLI {
class App;
}

namespace weft::app {

/// `weft calibrate`: one step of it.
using CalibrateArguments =
    std::variant<CalibrateCameraOptions, CalibrateResponseOptions, CalibrateColorOptions,
                 CalibrateLightsOptions, CalibrateCheckOptions, CheckRigOptions, CalibrateGreyOptions,
                 CalibratePatchesOptions, CalibrateUpdateOptions, CalibrateHistoryOptions>;

/// What is filled in while the command line is read: a form a step.
struct CalibrateForms {
  CalibrateCameraOptions camera;
  CalibrateResponseOptions response;
  CalibrateColorOptions color;
  std::vector<double> chart_corners;
  CalibrateLightsOptions lights;
  std::string lights_method = "physical";
  CalibrateCheckOptions check;
  CheckRigOptions check_rig;
  CalibrateGreyOptions grey;
  CalibratePatchesOptions patches;
  CalibrateUpdateOptions update;
  CalibrateHistoryOptions history;
};

/// Adds the verb `calibrate`, and a verb a step below it, which are returned.
std::vector<CLI::App*> add_calibrate(CLI::App& app, CalibrateForms& forms);

/// The step that was asked for, once `calibrate` was parsed.
CalibrateArguments chosen_step(const CLI::App& calibrate, const CalibrateForms& forms);

}  // namespace weft::app
