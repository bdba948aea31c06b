// SPDX-License-Identifier: Apache-2.0
// Formats of lines that are kept in testdata, of every version there ever was, by today's readers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/base/files.h"
#include "library/batch/outcome.h"
#include "library/batch/plan.h"
#include "tests/core/places.h"

namespace weft::library {
namespace {

const std::filesystem::path kSchemas = source_folder() / "testdata/schemas";

std::string stored(const std::string& file) {
  const Result<std::string> text = read_text(kSchemas / file);
  EXPECT_TRUE(text) << file;
  return text ? *text : "";
}

TEST(StoredLines, OfAPlanAreRead) {
  for (const std::string version : {"1", "1.1"}) {
    const std::string text = stored("weft.batch-" + version + "/night.jsonl");
    const Result<BatchPlan> plan = plan_from_text(text, "night.jsonl");
    ASSERT_TRUE(plan) << version << ": " << plan.error().message();
    ASSERT_EQ(plan->solves.size(), 1U);
    EXPECT_EQ(plan->solves[0].session, "/archive/twill.weft");
    EXPECT_EQ(plan->header.tasks.size(), 1U);
    EXPECT_EQ(plan->solves[0].forecast.solved, version == "1" ? 1 : 0.9375);
    BatchPlan again = *plan;
    EXPECT_EQ(text_of(again), text) << version;
  }
}

TEST(StoredLines, OfSessionsThatAPlanLeavesOutAreRead) {
  const std::string text = stored("weft.batch-1.1-left-out/night.jsonl");
  const Result<BatchPlan> plan = plan_from_text(text, "night.jsonl");
  ASSERT_TRUE(plan) << plan.error().message();
  ASSERT_EQ(plan->left_out.size(), 2U);
  EXPECT_EQ(plan->left_out[0].reason, SkipReason::kTurnsLittle);
  EXPECT_EQ(plan->left_out[0].seconds, 1.5);
  EXPECT_EQ(plan->left_out[1].kind, "bad_data");
  BatchPlan again = *plan;
  EXPECT_EQ(text_of(again), text);
}

TEST(StoredLines, OfAPlanOfANewerMajorVersionAreRefused) {
  std::string text = stored("weft.batch-1/night.jsonl");
  const std::string schema = "weft.batch/1";
  text.replace(text.find(schema), schema.size(), "weft.batch/2");
  const Result<BatchPlan> plan = plan_from_text(text, "night.jsonl");
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(plan.error().message(), testing::HasSubstr("weft.batch/2"));
}

TEST(StoredLines, OfResultsAreRead) {
  for (const std::string version : {"1", "1.1"}) {
    const std::string text = stored("weft.batch-result-" + version + "/task-0.jsonl");
    const Result<BatchPlan> plan =
        plan_from_text(stored("weft.batch-" + version + "/night.jsonl"), "night.jsonl");
    ASSERT_TRUE(plan) << plan.error().message();
    std::map<std::string, TaskHistory> histories;
    add_histories(text, plan->header.id, histories);
    ASSERT_EQ(histories.size(), 1U);
    const TaskHistory& history = histories.begin()->second;
    ASSERT_TRUE(history.result);
    EXPECT_EQ(history.result->solve, plan->solves[0].solve);
    EXPECT_EQ(history.result->solved.has_value(), version == "1.1");
    EXPECT_TRUE(history.result->change);
    EXPECT_EQ(line_of(*history.result), text);
  }
}

}  // namespace
}  // namespace weft::library
