// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/describe/fields.h"
#include "core/rig/scan_verdict.h"
#include "library/batch/change.h"

// What became of a session: a line of RESULTS/task-N.jsonl (weft.batch-result/1, docs/formats.md). Lines are
// only added; of a session the last one that is a result counts.

namespace weft::library {

enum class TaskState {
  kSolved,
  kThere,   ///< a complete solve of the same inputs was found
  kFailed,  ///< a result too: it is not tried again unless that is asked for
  kLost     ///< no result: killed, stopped, out of memory, a full disk
};
inline constexpr std::array kStateNames = {"solved", "there", "failed", "lost"};

struct TaskOutcome {
  std::string plan, session;
  TaskState state = TaskState::kLost;
  std::optional<Error> error = {};  ///< of kFailed and kLost
  std::string solve, folder;        ///< id, and where it is
  bool is_stored = false;           ///< `folder` is where it was sent to, which this machine may not see
  double seconds = 0, read_s = 0, solve_s = 0, compare_s = 0;  ///< wall
  double node_seconds = 0;  ///< the same of a machine with all threads of the plan to itself
  std::uint64_t peak_bytes = 0;
  int attempt = 1;
  std::string host;

  double expected_deg = 0;  ///< mean error that the solve expects of its normals; 0 where it was there
  double sigma_deg = 0, sigma_p95_deg = 0;  ///< that the solve says of its normals: median and p95
  double unsolved = 0;                      ///< share of pixels
  /// Share of the cloth that has a normal; none in lines of early versions.
  std::optional<double> solved = {};
  std::optional<double> left_out = {};      ///< rms of how left-out lights are predicted, a share
  std::vector<std::string> warnings = {};   ///< by name
  std::vector<std::string> frames = {};     ///< what is said of frames that lie, a sentence each
  std::optional<ScanVerdict> verdict = {};  ///< on the scan, with this solve; none in early lines
  std::vector<std::string> made = {};       ///< folders of maps and exports
  std::optional<MapChange> change = {};     ///< from the solve before
  std::string no_change = {};               ///< why it could not be compared with the solve before

  double solved_share() const { return solved.value_or(1 - unsolved); }
  bool is_result() const { return state != TaskState::kLost; }
  bool is_done() const { return state == TaskState::kSolved || state == TaskState::kThere; }
  friend bool operator==(const TaskOutcome&, const TaskOutcome&);
};

void describe(Fields& fields, TaskOutcome& outcome);

/// Whether an error says something of the session: then it is remembered. What says something of the machine
/// or the hour is not.
bool is_of_session(ErrorKind kind);

/// One line, with its end.
std::string line_of(const TaskOutcome& outcome);
/// Nothing for a line that was cut short by a kill, or is none.
std::optional<TaskOutcome> outcome_from_line(std::string_view line);

/// What the lines say of one session.
struct TaskHistory {
  std::optional<TaskOutcome> result = {};  ///< the last result
  std::optional<TaskOutcome> lost = {};    ///< the last line after it that is none
  int attempts = 0;
};
/// Adds what lines of this plan say, by session.
void add_histories(std::string_view lines, const std::string& plan, std::map<std::string, TaskHistory>& all);

}  // namespace weft::library
