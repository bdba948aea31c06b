// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/describe/fields.h"
#include "library/batch/outcome.h"
#include "library/batch/plan.h"

// What a batch came to.

namespace weft::library {

/// A session of the plan and what became of it. Neither solved nor failed: missing.
struct BatchRow {
  const PlannedSolve* planned = nullptr;
  std::optional<TaskOutcome> result = {};  ///< of kSolved, kThere or kFailed
  std::optional<TaskOutcome> lost = {};    ///< why the last attempt after it was none
  int attempts = 0;

  bool is_done() const { return result && result->is_done(); }
  bool has_failed() const { return result && result->state == TaskState::kFailed; }
  bool is_missing() const { return !result; }
};

/// Sessions that have one cause in common.
struct Cause {
  std::string kind;  ///< name_of(ErrorKind)
  std::string what;
  int sessions = 0;
  std::string example;  ///< the message of one
};

/// A calibration stands out whose left-out lights are off by this much more than is usual of the others.
inline constexpr double kStandsOut = 1.5;

/// Sessions that were solved by one calibration.
struct ByCalibration {
  std::string calibration, rig;
  int sessions = 0;
  int worse = 0;   ///< that have regressions
  int warned = 0;  ///< whose lights do not fit, or are exchanged, dead or of another gain
  std::optional<double> mean_turn_deg = {};
  std::optional<double> left_out = {};        ///< median rms of how left-out lights are predicted, a share
  std::optional<double> usual_left_out = {};  ///< the lower median of all calibrations, where this stands out
};

struct BatchSummary {
  int solved = 0, there = 0, failed = 0, missing = 0;
  int second_attempts = 0;                    ///< sessions that were begun more than once
  double seconds = 0, predicted_seconds = 0;  ///< of solved sessions, node-seconds
  MeanError error, predicted_error;           ///< of solved sessions: as solves expect it, and as predicted
  std::uint64_t peak_bytes = 0;
  std::vector<std::size_t> barely_solved;  ///< rows that are done and have under kLeastSolved of a cloth
  std::vector<std::size_t> warned;         ///< rows that are done and whose verdict is not good
  std::array<int, kGradeNames.size()> grades = {};  ///< rows that are done, by Grade
  std::vector<Cause> causes;                ///< of failed and missing sessions, the most frequent first
  std::vector<std::size_t> changed;         ///< rows that were compared, the gravest first (is_graver)
  int worse = 0;                            ///< compared rows with regressions
  int unchanged = 0;                        ///< compared rows without a changed pixel
  std::vector<ByCalibration> calibrations;  ///< the most suspect first
  std::vector<int> missing_tasks;           ///< with a missing session, rising

  /// How the night was foretold: predicted over taken seconds; 0 where nothing was solved or predicted.
  double seconds_ratio() const { return seconds > 0 ? predicted_seconds / seconds : 0; }
  bool is_whole() const { return failed == 0 && missing == 0; }
};

/// The rows of a plan, by what its tasks have written.
std::vector<BatchRow> rows_of(const BatchPlan& plan, const std::map<std::string, TaskHistory>& histories);

BatchSummary summarize(std::span<const BatchRow> rows);

/// "3 good, 1 usable, 1 to be taken again", without those of which there is none; empty where nobody judged.
std::string grades_in_words(const BatchSummary& summary);

/// What a batch came to, for programs.
struct SummaryDocument {
  BatchSummary summary;
  std::vector<BatchRow> rows;
};
void describe(Fields& fields, SummaryDocument& document);

}  // namespace weft::library
