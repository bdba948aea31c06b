// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/calibration.h"
#include "core/job.h"
#include "core/result.h"
#include "core/session.h"
#include "pipeline/photographs.h"

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
  std::vector<Shot> repeats;   ///< of those LEDs
  std::vector<Shot> brackets;  ///< of those LEDs, with an exposure ratio that the calibration measured
  Size size;
  bool raw = true;                    ///< mosaics; else linear TIFF, PNG or EXR
  Json description;                   ///< for solve.json, and what the id of the solve is made of
  std::vector<std::string> warnings;  ///< of shots that will not be used

  /// All shots whose frames are read: lit, dark, repeats, brackets.
  std::vector<Shot> frames() const;
};

Result<SessionPlan> plan_session(const SessionOptions& options);

/// Reads, checks against their digests and decodes every frame once, and corrects for the conditions they
/// were taken in (app/jobs/session_conditions.h).
Result<Photographs> load_session(const SessionPlan& plan, const JobContext& context);

}  // namespace weft::app
