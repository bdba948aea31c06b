// SPDX-License-Identifier: Apache-2.0
#include "library/batch/outcome.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace weft::library {
namespace {

TaskOutcome solved(const std::string& session) {
  TaskOutcome outcome;
  outcome.plan = "p1";
  outcome.session = session;
  outcome.state = TaskState::kSolved;
  outcome.solve = "0123";
  outcome.folder = session + "/solve/0123";
  outcome.seconds = 5.25;
  outcome.peak_bytes = 636'000'000;
  outcome.host = "node1";
  outcome.sigma_deg = 0.6;
  outcome.sigma_p95_deg = 1.6;
  outcome.expected_deg = 0.7;
  outcome.unsolved = 0.01;
  outcome.node_seconds = 11;
  outcome.read_s = 1.5;
  outcome.solve_s = 2.5;
  outcome.compare_s = 0.5;
  outcome.is_stored = true;
  outcome.made = {"/a/maps/1"};
  outcome.left_out = 0.05;
  outcome.warnings = {"LED_DEAD"};
  MapChange change;
  change.pixels = 100;
  change.mean_deg = 0.5;
  change.sigma_deg = {0.5, 0.6};
  change.worst = {16, 32, 80, 1.5};
  outcome.change = change;
  return outcome;
}

TaskOutcome ended(const std::string& session, TaskState state, ErrorKind kind) {
  TaskOutcome outcome;
  outcome.plan = "p1";
  outcome.session = session;
  outcome.state = state;
  outcome.error = {kind, "what", "where", "why", "remedy"};
  return outcome;
}

TEST(TaskOutcome, IsReadAsItWasWritten) {
  for (const TaskOutcome& outcome :
       {solved("/a.weft"), ended("/b.weft", TaskState::kFailed, ErrorKind::kBadData),
        ended("/c.weft", TaskState::kLost, ErrorKind::kTryAgain)}) {
    const std::string line = line_of(outcome);
    EXPECT_EQ(line.find('\n'), line.size() - 1);
    const std::optional<TaskOutcome> read = outcome_from_line(line);
    ASSERT_TRUE(read) << line;
    EXPECT_EQ(*read, outcome) << line_of(*read);
  }
  const TaskOutcome wrote = solved("/a.weft"), read = *outcome_from_line(line_of(wrote));
  EXPECT_EQ(read.change, wrote.change);
  EXPECT_EQ(read.sigma_p95_deg, wrote.sigma_p95_deg);
  EXPECT_EQ(read.expected_deg, wrote.expected_deg);
  EXPECT_EQ(read.unsolved, wrote.unsolved);
  EXPECT_EQ(read.node_seconds, wrote.node_seconds);
  EXPECT_EQ(read.read_s + read.solve_s + read.compare_s, wrote.read_s + wrote.solve_s + wrote.compare_s);
  EXPECT_EQ(read.is_stored, wrote.is_stored);
  EXPECT_EQ(read.made, wrote.made);
}

TEST(TaskOutcome, CutShortAtAnyByteIsNone) {
  const std::string line = line_of(solved("/a.weft"));
  for (std::size_t bytes = 0; bytes + 2 < line.size(); ++bytes)
    EXPECT_FALSE(outcome_from_line(line.substr(0, bytes))) << bytes;
}

TEST(Histories, TakeTheLastResultAndPassOverWhatIsNone) {
  const std::string lines = line_of(ended("/a.weft", TaskState::kLost, ErrorKind::kTryAgain)) +
                            line_of(solved("/a.weft")).substr(0, 40) + "\n" + line_of(solved("/a.weft")) +
                            line_of(ended("/b.weft", TaskState::kFailed, ErrorKind::kBadData)) +
                            line_of(ended("/b.weft", TaskState::kLost, ErrorKind::kTryAgain));
  std::map<std::string, TaskHistory> histories;
  add_histories(lines, "p1", histories);
  ASSERT_EQ(histories.size(), 2U);
  const TaskHistory &a = histories.at("/a.weft"), &b = histories.at("/b.weft");
  EXPECT_TRUE(a.result && a.result->is_done());
  EXPECT_FALSE(a.lost);
  EXPECT_EQ(a.attempts, 2);
  EXPECT_EQ(b.result->state, TaskState::kFailed) << "what is no result takes none back";
  EXPECT_TRUE(b.lost);
}

TEST(Histories, PassOverTheLinesOfAnotherPlan) {
  std::map<std::string, TaskHistory> histories;
  add_histories(line_of(solved("/a.weft")), "p2", histories);
  EXPECT_TRUE(histories.empty());
}

TEST(Failures, AreOfTheSessionAndNotOfTheHour) {
  for (const ErrorKind kind : {ErrorKind::kBadData, ErrorKind::kNoInput, ErrorKind::kInternal})
    EXPECT_TRUE(is_of_session(kind));
  for (const ErrorKind kind :
       {ErrorKind::kTryAgain, ErrorKind::kInterrupted, ErrorKind::kInputOutput, ErrorKind::kCannotCreate})
    EXPECT_FALSE(is_of_session(kind));
}

}  // namespace
}  // namespace weft::library
