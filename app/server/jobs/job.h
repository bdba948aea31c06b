// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/describe/fields.h"

namespace weft::app {

/// At the begin of an argument of a job: the folder of what it makes beside its result, which is forgotten
/// with it. The folder is there where an argument names a file in it.
inline constexpr const char* kJobFiles = "{files}";

/// Names the seconds that a job is planned to take, in what it wants. Its share is then one of seconds.
inline constexpr const char* kPlannedSeconds = "planned_s";

/// What a job is to do: a verb of weft with its arguments, as a process of its own.
struct JobSpec {
  std::string kind;  ///< "solve", "rectify", "calibrate lights", ...
  std::string of;    ///< what it works on, for people: the name of a session
  /// Arguments of weft: {"solve", "/data/a.weft", "--quality", "robust"}. kJobFiles stands for a folder of
  /// its own.
  std::vector<std::string> arguments;
  std::string by;                       ///< who asked for it
  std::string request_id;               ///< the same again is the same job; empty: none
  std::vector<std::string> needs = {};  ///< files and folders that must be there when it begins
  Json wants = Json::object();          ///< what was asked of it beside its kind: "quality", "session", ...
};

enum class JobState { kQueued, kRunning, kDone, kFailed, kCancelled };
const char* name_of(JobState state);  ///< "queued"

/// How a job is.
struct JobStatus {
  std::string id;  ///< "000042", in the order they were asked for
  JobSpec spec;
  JobState state = JobState::kQueued;
  bool is_held = false;      ///< it runs, and waits until a scan lets it go on
  std::optional<int> place;  ///< among those that wait, from 1
  std::string phase;         ///< of a running one, as its verb calls it; and how much of it is done
  double share = 0;
  std::optional<double> left_s;  ///< by the price of its session, else by how long the last job like it took
  std::string asked, began, ended;  ///< ISO 8601; empty: not yet
  double seconds = 0;               ///< that it ran, without those that it was held for
  std::optional<int> exit_code;
  std::vector<std::string> notes;  ///< what it said to people
  Json error;                      ///< as core/describe/error_json.h has it; null where there was none
  Json result;                     ///< the document that its verb prints with --json; null until it is done
};

/// As a client sees it.
void describe(Fields& fields, JobStatus& job);

/// A job as it lies on the disk (weft.job/1): with "arguments", "request_id" and "needs". kBadData.
Json document_of(const JobStatus& job);
Result<JobStatus> job_from_json(const Json& document, const std::string& where);

}  // namespace weft::app
