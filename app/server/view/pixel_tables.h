// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/solve/solve.h"
#include "solve/photographs/photographs.h"

namespace weft::app {

/// The readings that a solve was made from, in memory, to be asked about one pixel after another. Safe from
/// any thread.
class PixelTable {
 public:
  /// Reads the session as the solve did: the same shots, the same calibration, corrected alike, without the
  /// shots that the solve left out. kBadData where the session has changed since, or its calibration is
  /// another one than the solve names; errors of plan_session() and load_photographs().
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

  solve::Photographs photographs_;
  std::string method_;
  std::vector<UnusedLed> whole_shots_;  // LEDs that were not solved from
};

/// The readings of the solve that is asked about, in memory: read in the background when its first pixel is
/// asked for, and let go two minutes after the last. Safe from any thread.
class PixelTables {
 public:
  PixelTables();
  ~PixelTables();

  /// PixelTable::at(); nothing while readings are being read. kNoInput for a place outside; errors of
  /// PixelTable::read(), each said once.
  Result<std::optional<Json>> at(const std::filesystem::path& session, const SolveFacts& solve, int x, int y);

 private:
  struct Wanted {
    std::filesystem::path session;
    SolveFacts solve;
  };
  void run(const std::stop_token& stop);

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<Wanted> wanted_;
  std::string id_;  ///< of the solve whose readings, or error, these are
  std::shared_ptr<const PixelTable> table_;
  std::optional<Error> error_;
  std::chrono::steady_clock::time_point asked_;
  std::jthread thread_;  ///< the last member: it uses all others
};

}  // namespace weft::app
