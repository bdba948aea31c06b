// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/describe/fields.h"
#include "library/import/import_plan.h"

namespace weft::library {

/// What `weft import` and a job that imports are told.
struct ImportRequest {
  ImportOptions import;
  bool has_ball = false;           ///< balls in the photographs tell their lights
  std::string ball_kind = "auto";  ///< else a name of calibration::kBallKindNames
  calibration::BallsOptions balls;
  bool yes = false, dry_run = false;

  /// `import` with what is known of balls.
  ImportOptions options() const;
};
void describe(Fields& fields, ImportRequest& request);

}  // namespace weft::library
