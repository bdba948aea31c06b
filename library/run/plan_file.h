// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "library/batch/outcome.h"
#include "library/batch/plan.h"

// A plan on disk, and beside it NAME.results/ with a file a task.

namespace weft::library {

struct PlanFile {
  std::filesystem::path file;
  BatchHeader header;
  std::uint64_t lines_at = 0;  ///< where the first line after the header begins

  std::filesystem::path results() const;
  std::filesystem::path results_of(int task) const;  ///< task-N.jsonl
};

/// Reads the header alone. kNoInput, kBadData.
Result<PlanFile> open_plan(const std::filesystem::path& file);
/// Reads the lines of one task alone. kUsage where there is no such task, kBadData.
Result<std::vector<PlannedSolve>> read_task(const PlanFile& plan, int task);
/// Reads all of it, checked against its id.
Result<BatchPlan> read_plan(const std::filesystem::path& file);
/// Writes a plan, or finds the same there. A plan never changes: kCannotCreate where another is there.
Result<void> write_plan(const std::filesystem::path& file, const std::string& text);

/// What tasks have written so far, by session; of all tasks where none is named.
Result<std::map<std::string, TaskHistory>> read_histories(const PlanFile& plan,
                                                          const std::vector<int>& tasks);
/// Adds a line and syncs it. A line that a kill cut short is ended first.
Result<void> add_outcome(const PlanFile& plan, int task, const TaskOutcome& outcome);

}  // namespace weft::library
