// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/describe/fields.h"
#include "library/batch/plan.h"

namespace weft::library {

struct PlanBatchOptions {
  std::vector<std::string> sessions;            ///< folders of sessions, or with sessions below them
  std::string quality = "standard";             ///< where neither of the next two is asked
  std::optional<double> to_deg = {};            ///< of each session the cheapest level that is so close
  std::optional<double> within_seconds = {};    ///< for all: spent where a second buys most degrees
  std::optional<double> least_change_deg = {};  ///< maps that would turn by less are left as they are
  BatchProduct product;
  /// In place of the own ones of the sessions of their rigs.
  std::vector<std::filesystem::path> calibrations;
  int sample = 50;           ///< sessions that are measured
  double task_minutes = 10;  ///< of a task
  /// Where solves go, for archives that cannot be written; empty: each session.
  std::filesystem::path output;
  std::filesystem::path plan = "batch.jsonl";  ///< the file to write
};
/// All but the sessions.
void describe(Fields& fields, PlanBatchOptions& options);
/// Which maps of a solve stay.
void describe_kept_maps(Fields& fields, std::vector<std::string>& keep, bool& half);

struct PlanBatchReport {
  BatchPlan plan;
  std::filesystem::path file;
  double seconds = 0;  ///< of planning, the sample not among them
};

/// Looks at sessions without opening a photograph, measures a sample of them, and what follows a solve on one
/// of each size, carries that over to the others, chooses their levels, gives them to tasks, and writes the
/// plan. Each session that is not solved is in it, with why: its solve is there, it cannot be solved, its
/// maps would turn by little, no level is close enough.
///
/// Errors: those of what cannot follow a solve, before a session is planned; kUsage where options do not go
/// together or nothing fits; kNoInput where there is no session; kCannotCreate where the file is taken;
/// kInterrupted.
Result<PlanBatchReport> plan_batch(const PlanBatchOptions& options, const JobContext& context);

}  // namespace weft::library
