// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/jobs/job.h"
#include "app/jobs/photographs.h"
#include "core/calibration.h"
#include "core/result.h"
#include "core/session.h"

namespace weft::app {

struct SessionOptions {
  std::filesystem::path folder;
  std::filesystem::path calibration;  ///< empty: the session's own
  std::vector<int> leds;              ///< empty: all that were lit
};

/// A session that has been looked at but not read: everything that can be checked before an hour of work.
struct SessionPlan {
  Session session;
  Calibration calibration;
  std::vector<Shot> lit;  ///< the shots to solve from, by LED
  std::optional<Shot> dark;
  Size size;
  bool raw = true;   ///< mosaics; else linear TIFF, PNG or EXR
  Json description;  ///< for solve.json, and what the id of the solve is made of
};

Result<SessionPlan> plan_session(const SessionOptions& options);

/// Reads, checks against their digests and decodes every frame once.
Result<Photographs> load_session(const SessionPlan& plan, const JobContext& context);

}  // namespace weft::app
