// SPDX-License-Identifier: Apache-2.0
#include "library/batch/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "core/describe/field_json.h"

#include "tests/library/batch/sample_plan.h"

namespace weft::library {
namespace {

TaskOutcome done(const PlannedSolve& planned, double seconds = 50) {
  TaskOutcome outcome;
  outcome.session = planned.session;
  outcome.state = TaskState::kSolved;
  outcome.solve = planned.solve;
  outcome.seconds = 2 * seconds;
  outcome.node_seconds = seconds;
  outcome.sigma_deg = 0.7;
  outcome.left_out = 0.03;
  return outcome;
}

TaskOutcome ended(const PlannedSolve& planned, TaskState state, ErrorKind kind, const std::string& what) {
  TaskOutcome outcome;
  outcome.session = planned.session;
  outcome.state = state;
  outcome.error = {kind, what, planned.session, "", ""};
  return outcome;
}

TEST(BatchSummary, CountsWhatIsSolvedFailedAndMissing) {
  const BatchPlan plan = sample_plan(6);
  std::map<std::string, TaskHistory> histories;
  histories[plan.solves[0].session] = {done(plan.solves[0]), {}, 1};
  histories[plan.solves[1].session] = {done(plan.solves[1], 70), {}, 2};
  histories[plan.solves[2].session] = {
      ended(plan.solves[2], TaskState::kFailed, ErrorKind::kBadData, "raw is damaged"), {}, 1};
  histories[plan.solves[3].session] = {
      ended(plan.solves[3], TaskState::kFailed, ErrorKind::kBadData, "raw is damaged"), {}, 1};
  histories[plan.solves[4].session] = {
      {}, ended(plan.solves[4], TaskState::kLost, ErrorKind::kTryAgain, "out of memory"), 1};
  const std::vector<BatchRow> rows = rows_of(plan, histories);
  const BatchSummary summary = summarize(rows);
  EXPECT_EQ(summary.solved, 2);
  EXPECT_EQ(summary.failed, 2);
  EXPECT_EQ(summary.missing, 2);
  EXPECT_EQ(summary.second_attempts, 1);
  EXPECT_FALSE(summary.is_whole());
  EXPECT_DOUBLE_EQ(summary.seconds, 120);
  EXPECT_DOUBLE_EQ(summary.predicted_seconds, 200);
  EXPECT_THAT(summary.missing_tasks, testing::ElementsAre(2));
  ASSERT_EQ(summary.causes.size(), 3U);
  EXPECT_EQ(summary.causes[0].what, "raw is damaged");
  EXPECT_EQ(summary.causes[0].sessions, 2);
  EXPECT_THAT(summary.causes[0].example, testing::HasSubstr("cloth-2"));
  EXPECT_EQ(object_of(SummaryDocument{summary, rows})["sessions"].size(), 6U);
}

TEST(BatchSummary, NamesWhatIsHardlySolvedAndWeighsErrorsByTheClothThatTheyHoldFor) {
  const BatchPlan plan = sample_plan(3);
  std::map<std::string, TaskHistory> histories;
  for (const PlannedSolve& planned : plan.solves) histories[planned.session] = {done(planned, 80), {}, 1};
  TaskOutcome& spoiled = *histories[plan.solves[1].session].result;
  spoiled.expected_deg = 0.25;
  spoiled.solved = 0.1;
  spoiled.warnings = {"OVEREXPOSED"};
  for (const int good : {0, 2})
    histories[plan.solves[static_cast<std::size_t>(good)].session].result->expected_deg = 0.8;
  const std::vector<BatchRow> rows = rows_of(plan, histories);
  const BatchSummary summary = summarize(rows);
  EXPECT_EQ(summary.solved, 3);
  EXPECT_THAT(summary.barely_solved, testing::ElementsAre(1U));
  EXPECT_THAT(summary.warned, testing::ElementsAre(1U));
  EXPECT_DOUBLE_EQ(summary.error.solved(), 2.1 / 3);
  EXPECT_DOUBLE_EQ(summary.error.degrees(), (2 * 0.8 + 0.1 * 0.25) / 2.1);
  EXPECT_DOUBLE_EQ(summary.seconds_ratio(), summary.predicted_seconds / 240);
  const Json json = object_of(SummaryDocument{summary, rows});
  EXPECT_EQ(json["barely_solved"], Json({plan.solves[1].session}));
  EXPECT_EQ(json["seconds_ratio"], summary.seconds_ratio());
  EXPECT_EQ(json["sessions"][1]["solved"], 0.1);
}

TEST(BatchSummary, NamesTheCalibrationFirstThatMadeSessionsWorse) {
  BatchPlan plan = sample_plan(6);
  std::map<std::string, TaskHistory> histories;
  for (std::size_t i = 0; i < plan.solves.size(); ++i) {
    PlannedSolve& planned = plan.solves[i];
    planned.calibration = i < 2 ? "good" : i < 4 ? "wrong" : "fine";
    TaskOutcome outcome = done(planned);
    MapChange change;
    change.mean_deg = change.p95_deg = change.max_deg = i < 2 ? 9 : 2;
    change.sigma_deg = {0.5, planned.calibration == "wrong" ? 0.9 : 0.5};
    outcome.change = change;
    histories[planned.session] = {outcome, {}, 1};
  }
  const std::vector<BatchRow> rows = rows_of(plan, histories);
  const BatchSummary summary = summarize(rows);
  ASSERT_EQ(summary.calibrations.size(), 3U);
  EXPECT_EQ(summary.calibrations.front().calibration, "wrong");
  EXPECT_EQ(summary.calibrations.front().worse, 2);
  EXPECT_EQ(summary.worse, 2);
  ASSERT_EQ(summary.changed.size(), 6U);
  EXPECT_EQ(rows[summary.changed[0]].planned->calibration, "wrong")
      << "regressions come before what turned further";
  EXPECT_EQ(rows[summary.changed[2]].planned->calibration, "good");
}

TEST(BatchSummary, NamesTheCalibrationFirstWhoseLeftOutLightsAreOffWhereNothingWasSolvedBefore) {
  BatchPlan plan = sample_plan(4);
  std::map<std::string, TaskHistory> histories;
  for (std::size_t i = 0; i < plan.solves.size(); ++i) {
    plan.solves[i].calibration = i % 2 == 0 ? "a" : "b";
    TaskOutcome outcome = done(plan.solves[i]);
    outcome.left_out = i % 2 == 0 ? 0.03 : 0.12;
    histories[plan.solves[i].session] = {outcome, {}, 1};
  }
  EXPECT_EQ(summarize(rows_of(plan, histories)).calibrations.front().calibration, "b");
}

TEST(BatchSummary, OfAnUnchangedArchiveHasNoChangedPixel) {
  const BatchPlan plan = sample_plan(2);
  std::map<std::string, TaskHistory> histories;
  for (const PlannedSolve& planned : plan.solves) {
    TaskOutcome outcome = done(planned);
    outcome.change = MapChange{.pixels = 100};
    histories[planned.session] = {outcome, {}, 1};
  }
  const BatchSummary summary = summarize(rows_of(plan, histories));
  EXPECT_EQ(summary.unchanged, 2);
  EXPECT_EQ(summary.worse, 0);
  EXPECT_TRUE(summary.is_whole());
}

}  // namespace
}  // namespace weft::library
