// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/describe/fields.h"

// The plan of a batch as a document (weft.batch/1, docs/formats.md): JSON lines that never change once they
// are written. The first line is the header, then comes a line a session, task by task, then a line for each
// session that is left out. The header says where the lines of each task lie, so that a task reads its own
// alone.

namespace weft::library {

inline constexpr const char* kPlanSchema = "weft.batch/1";  // 1.1 where shares of the cloth are in it

/// What becomes of each solve besides its level.
struct BatchProduct {
  std::vector<std::string> keep = {};  ///< maps that stay, by name: "normal"; none: all
  bool half = false;                   ///< normals as half floats
  std::string compression = "none";    ///< of EXR files
  std::vector<std::string> then = {};  ///< made of it afterwards: "maps", "export:unreal"

  bool is_whole() const { return keep.empty() && !half; }
  friend bool operator==(const BatchProduct&, const BatchProduct&) = default;
};

/// A calibration that is used in place of the own ones of a rig's sessions.
struct NamedCalibration {
  std::string folder, id, rig;

  friend bool operator==(const NamedCalibration&, const NamedCalibration&) = default;
};

/// What one solve is expected to give and to cost.
struct Forecast {
  double seconds = 0, seconds_spread = 0;  ///< spread: a standard deviation, 0 where it is not known
  double degrees = 0, degrees_spread = 0;  ///< mean error of the normals
  bool is_measured = false;                ///< on this very session; else carried over from others
  std::optional<double> turn_deg = {};     ///< mean angle to the solve before
  double solved = 1;                       ///< share of the cloth that has a normal: `degrees` holds for it
  /// The solve's own part of `seconds`, as its solve.json counts it; 0 where nothing was measured, and in
  /// plans of early versions.
  double solve_seconds = 0;

  friend bool operator==(const Forecast&, const Forecast&) = default;
};

/// One session that is solved.
struct PlannedSolve {
  std::string session;  ///< its folder
  std::string digest;   ///< digest_of_session()
  int task = 0;
  std::string quality;      ///< level, "standard"
  std::string calibration;  ///< id
  std::string solve;        ///< id that its solve will have
  std::string before;       ///< id of the current solve, which it is compared with; empty: there is none
  std::string rig, fabric;
  double megapixels = 0;
  Forecast forecast;
  std::uint64_t memory_bytes = 0, read_bytes = 0, write_bytes = 0;

  friend bool operator==(const PlannedSolve&, const PlannedSolve&) = default;
};

/// Why a session is not solved.
enum class SkipReason { kThere, kUnsolvable, kTurnsLittle, kNotGoodEnough };
inline constexpr std::array kReasonNames = {"there", "unsolvable", "turns_little", "not_good_enough"};

struct SkippedSession {
  std::string session;
  SkipReason reason = SkipReason::kThere;
  std::string kind = {};  ///< of an error: name_of(ErrorKind)
  std::string said;       ///< one sentence
  double seconds = 0;     ///< that are saved

  friend bool operator==(const SkippedSession&, const SkippedSession&) = default;
};

/// Adds up the errors of many cloths: their mean over all that has a normal.
class MeanError {
 public:
  void add(double degrees, double solved) { sum_ += solved * degrees, solved_ += solved, ++cloths_; }
  double degrees() const { return solved_ > 0 ? sum_ / solved_ : 0; }
  double solved() const { return cloths_ > 0 ? solved_ / cloths_ : 0; }  ///< share of all cloth

 private:
  double sum_ = 0, solved_ = 0;
  int cloths_ = 0;
};
/// As it is planned.
MeanError error_of(std::span<const PlannedSolve> solves);

/// All sessions at one level.
struct LevelTotal {
  std::string quality;
  double hours = 0, mean_deg = 0, spread_deg = 0;
  int sessions = 0;  ///< that the plan solves at it
  /// Share of the cloth that mean_deg holds for; none in plans of early versions.
  std::optional<double> solved = {};

  friend bool operator==(const LevelTotal&, const LevelTotal&) = default;
};

/// Hours and the mean error that they buy, over the whole cloth (deg_of_whole).
struct Spent {
  double hours = 0, mean_deg = 0;

  friend bool operator==(const Spent&, const Spent&) = default;
};

/// Where the lines of one task lie, and what they cost.
struct TaskPlace {
  std::uint64_t offset = 0, bytes = 0;  ///< from the end of the header's line
  int sessions = 0;
  double seconds = 0;
  std::uint64_t memory_bytes = 0;  ///< of the largest

  friend bool operator==(const TaskPlace&, const TaskPlace&) = default;
};

struct BatchHeader {
  std::string id;       ///< 16 hexadecimal digits of the SHA-256 of all else
  std::string archive;  ///< the folder that holds all sessions
  std::string output;   ///< folder for solves beside the archive; empty: each in its session
  BatchProduct product;
  std::vector<NamedCalibration> calibrations;
  int solver_version = 0;
  int threads = 0;  ///< that the seconds hold for
  int sampled = 0;  ///< sessions that were measured
  double sample_seconds = 0;
  std::vector<LevelTotal> levels;  ///< those that were measured: all, or the one that was asked for
  std::vector<Spent> curve;        ///< where hours were given out
  std::vector<TaskPlace> tasks;
  int sessions = 0, left_out = 0;

  friend bool operator==(const BatchHeader&, const BatchHeader&) = default;
};

struct BatchPlan {
  BatchHeader header;
  std::vector<PlannedSolve> solves;  ///< by task
  std::vector<SkippedSession> left_out;

  friend bool operator==(const BatchPlan&, const BatchPlan&) = default;
};

void describe(Fields& fields, PlannedSolve& planned);
void describe(Fields& fields, SkippedSession& left_out);
void describe(Fields& fields, BatchHeader& header);

/// SHA-256 of what a solve depends on in session.json: all but what people say of the cloth (fabric,
/// metadata), the current solve, and where copies lie.
std::string digest_of_session(Json document);

/// A task has at most so many sessions, where seconds are few or not known.
inline constexpr int kMostOfTask = 100;

/// Gives solves to tasks of about so many seconds, in their order; a task has at least one.
void share_out(std::vector<PlannedSolve>& solves, double task_seconds);

/// The text of a plan whose solves have their tasks, which rise from 0 by one; fills the header's id, tasks
/// and counts.
std::string text_of(BatchPlan& plan);

/// Reads the first line. kBadData, `where` being the file's name for messages: no plan, or one of a newer
/// version.
Result<BatchHeader> header_from_line(std::string_view line, const std::string& where);
/// Reads lines of solves.
Result<std::vector<PlannedSolve>> solves_from_lines(std::string_view lines, const std::string& where);
/// Reads all of it. kBadData also where lines are missing, or were changed since they were written.
Result<BatchPlan> plan_from_text(std::string_view text, const std::string& where);

/// Where the solves of a session go: the parent of the folders by id.
std::string solve_parent(const BatchHeader& header, const std::string& session);

}  // namespace weft::library
