// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/server/api/bodies/body_fields.h"
#include "calibration/guide/photograph_set.h"
#include "calibration/guide/printed_target.h"
#include "core/base/json_document.h"
#include "core/describe/fields.h"

// What calls may say that are no job and no scan: read by read_body(), and described in OpenAPI by the
// names that request_schemas() gives them.

namespace weft::app {

inline constexpr double kLongestShot_us = 30e6;

struct DevicesRequest {
  bool open = false;
};
struct LightRequest {
  std::vector<int> leds;
  bool round = false;
  int most_leds = 10;  ///< of the rig
};
struct TestShotRequest {
  int led = 0;
  double exposure_us = 0;
  int most_leds = 10;
};
struct AgainRequest {
  double exposure_us = 0;
};
struct ControlRequest {
  std::string name;
  bool take = false;
};
struct SetWorkRequest {
  calibration::SetPart part = calibration::SetPart::kBoard;
  std::string name, description, from;
  Json thing = Json::object();
};
struct LeaveOutRequest {
  std::string name;
  bool out = true;
};
struct AcceptRequest {
  std::filesystem::path calibration;
  bool dry_run = false;
};

void describe(Fields& fields, DevicesRequest& request);
void describe(Fields& fields, LightRequest& request);
void describe(Fields& fields, TestShotRequest& request);
void describe(Fields& fields, AgainRequest& request);
void describe(Fields& fields, ControlRequest& request);
void describe(Fields& fields, SetWorkRequest& request);
void describe(Fields& fields, LeaveOutRequest& request);
void describe(Fields& fields, AcceptRequest& request);

/// Components of OpenAPI: "ScanRequest" and these.
Json request_schemas();

}  // namespace weft::app
