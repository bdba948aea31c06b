// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "library/batch/plan.h"
#include "library/batch/summary.h"
#include "library/run/plan_file.h"

namespace weft::library {

/// A plan and what its tasks have made of it so far.
struct BatchState {
  PlanFile file;
  BatchPlan plan;
  std::vector<BatchRow> rows;  ///< of plan.solves
  BatchSummary summary;

  BatchState() = default;
  BatchState(BatchState&&) = default;  // rows point into the plan's list, which moves as it is
  BatchState& operator=(BatchState&&) = default;
  BatchState(const BatchState&) = delete;
  BatchState& operator=(const BatchState&) = delete;
};

/// Reads plan and results. The folders of solves are the truth: one that is there without a line counts, and
/// a line whose folder is gone does not. Errors of read_plan() and read_histories().
Result<BatchState> read_batch(const std::filesystem::path& plan);

struct MergeReport {
  BatchState state;
  std::filesystem::path folder;  ///< RESULTS/report
  int abandoned = 0;             ///< half-made folders that were removed (abandoned.h)
};

/// Two solves that were drawn, as the report lists them.
struct ListedPicture {
  std::string session, file;  ///< its folder; beside the report
};

void describe(Fields& fields, ListedPicture& picture);

/// A session that was not solved, as the report lists it.
struct ListedLeftOut {
  SkippedSession left_out;
};

/// What report.json says of a batch (weft.batch-report/1.1).
struct BatchReportFacts {
  std::string plan;  ///< id
  SummaryDocument summary;
  std::vector<ListedLeftOut> left_out;
  std::vector<ListedPicture> pictures;
  int abandoned = 0;
};
void describe(Fields& fields, BatchReportFacts& facts);

/// So many pairs of solves are drawn: those that changed most gravely.
inline constexpr std::size_t kMostDrawn = 10;

/// Reads what became of a batch, removes what dead processes left half made, and writes report/: report.json
/// (weft.batch-report/1.1, docs/formats.md), report.html and worst-NN.png. Written anew by each merge. Errors
/// of read_batch(); kCannotCreate, kInputOutput.
Result<MergeReport> merge_batch(const std::filesystem::path& plan, const JobContext& context);

}  // namespace weft::library
