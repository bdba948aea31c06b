// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "calibration/guide/rig_plan.h"
#include "core/base/result.h"
#include "core/describe/fields.h"

namespace weft::calibration {

/// What `weft rig plan` and a job that plans lights are told.
struct RigPlanRequest {
  RigPlanOptions plan;
  std::string cloth = "satin";        ///< of planned_cloths()
  std::filesystem::path reflectance;  ///< in place of it the lobe of a solve; empty: not
  std::filesystem::path picture;      ///< empty: none
  std::optional<double> roughness, f0, albedo, relief_deg;

  /// The cloth that is asked for. kBadData.
  Result<NamedCloth> asked_cloth() const;
};
void describe(Fields& fields, RigPlanRequest& request);

}  // namespace weft::calibration
