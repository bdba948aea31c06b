// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/base/job.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/solve/solve.h"
#include "solve/input/session_input.h"

namespace weft::app {

/// The readings that a solve was made from, in memory, to be asked about one pixel after another. Safe from
/// any thread.
class PixelTable {
 public:
  /// Reads the session as the solve did: the same shots, the same calibration, corrected alike, without the
  /// shots that the solve left out. kBadData where the session has changed since, or its calibration is
  /// another one than the solve names; errors of plan_session() and load_session().
  static Result<std::unique_ptr<PixelTable>> read(const std::filesystem::path& session,
                                                  const SolveFacts& solve, const JobContext& context);

  Size size() const { return photographs_.size; }
  /// {"x", "y", "channel", "counts_dark", "solved": {"normal", "albedo", "residual", "status"},
  /// "readings": [{"led", "counts", "reading", "model", "sigma", "residual_sigma", "used", "left_out",
  /// "light_dir", "strength"}]} of a pixel, solved by itself in double (solver/in_double/pixel.h): what it
  /// makes of each reading. "left_out" is saturated, missing, shadowed or rejected, of whole shots not lit or
  /// moved, of used readings null. Readings are as core/rig/radiometry.h has them, after all that is known
  /// was corrected; those of a pixel with three planes are their weighted sum over the strengths.
  Json at(int x, int y) const;

 private:
  PixelTable() = default;

  pipeline::Photographs photographs_;
  std::string method_;
  std::vector<UnusedLed> whole_shots_;  // LEDs that were not solved from
};

}  // namespace weft::app
