// SPDX-License-Identifier: Apache-2.0
#include "library/batch/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/library/batch/sample_plan.h"

namespace weft::library {
namespace {

TEST(BatchPlan, IsReadAsItWasWritten) {
  BatchPlan plan = sample_plan(5);
  plan.header.product = {{"normal", "albedo"}, true, "zip", {}};
  plan.header.calibrations = {{"/rig/new", "beef", "rig a"}};
  plan.header.curve = {{0.5, 2.5}, {1.0, 0.7}};
  plan.solves[3].before = "old";
  plan.solves[3].forecast.turn_deg = 0.25;
  plan.solves[2].forecast.solved = 0.9;
  plan.solves[2].forecast.solve_seconds = 80;
  plan.header.levels[0].solved = 0.95;
  plan.left_out = {{"/archive/a.weft", SkipReason::kUnsolvable, "bad_data", "it is \"odd\"\nand long", 0},
                   {"/archive/b.weft", SkipReason::kTurnsLittle, "", "", 12.5}};
  const std::string text = text_of(plan);
  const Result<BatchPlan> read = plan_from_text(text, "plan");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(*read, plan);
  EXPECT_EQ(read->header.id.size(), 16U);
  EXPECT_EQ(read->header.left_out, 2);
}

TEST(BatchPlan, WeighsTheErrorOfEachClothByTheShareThatItHoldsFor) {
  std::vector<PlannedSolve> solves = {sample_solve(0), sample_solve(1)};
  solves[0].forecast.degrees = 0.8;
  solves[1].forecast.degrees = 0.25;
  solves[1].forecast.solved = 0.1;
  EXPECT_DOUBLE_EQ(error_of(solves).degrees(), (0.8 + 0.025) / 1.1);
  EXPECT_DOUBLE_EQ(error_of(solves).solved(), 0.55);
  EXPECT_EQ(error_of({}).degrees(), 0);
}

TEST(BatchPlan, HasATaskOfAboutSoManySeconds) {
  std::vector<PlannedSolve> solves = {sample_solve(0, 100), sample_solve(1, 149), sample_solve(2, 2),
                                      sample_solve(3, 900), sample_solve(4, 250)};
  share_out(solves, 250);
  std::vector<int> tasks;
  for (const PlannedSolve& planned : solves) tasks.push_back(planned.task);
  EXPECT_THAT(tasks, testing::ElementsAre(0, 0, 1, 2, 3));
}

TEST(BatchPlan, WhoseSecondsAreNotKnownHasTasksOfAHundredSessions) {
  std::vector<PlannedSolve> solves;
  for (int i = 0; i < 250; ++i) solves.push_back(sample_solve(i, 0));
  share_out(solves, 600);
  EXPECT_EQ(solves[99].task, 0);
  EXPECT_EQ(solves[100].task, 1);
  EXPECT_EQ(solves.back().task, 2);
}

TEST(BatchPlan, SaysWhereTheLinesOfEachTaskLie) {
  BatchPlan plan = sample_plan(7);
  const std::string text = text_of(plan);
  const std::size_t lines_at = text.find('\n') + 1;
  ASSERT_EQ(plan.header.tasks.size(), 4U);
  int number = 0;
  for (std::size_t task = 0; task < plan.header.tasks.size(); ++task) {
    const TaskPlace& place = plan.header.tasks[task];
    const Result<std::vector<PlannedSolve>> solves =
        solves_from_lines(std::string_view(text).substr(lines_at + place.offset, place.bytes), "plan");
    ASSERT_TRUE(solves) << solves.error().message();
    EXPECT_EQ(static_cast<int>(solves->size()), place.sessions);
    EXPECT_DOUBLE_EQ(place.seconds, 100.0 * place.sessions);
    for (const PlannedSolve& planned : *solves)
      EXPECT_EQ(planned, plan.solves[static_cast<std::size_t>(number++)]);
    EXPECT_EQ(place.memory_bytes, solves->back().memory_bytes) << "the largest of task " << task;
  }
  EXPECT_EQ(number, 7);
}

TEST(BatchPlan, ThatWasChangedIsRefused) {
  BatchPlan plan = sample_plan(3);
  const std::string text = text_of(plan);
  std::string changed = text;
  changed[text.find("cloth-2")] = 'k';
  std::string shorter = text.substr(0, text.rfind('\n', text.size() - 2) + 1);
  for (const std::string& each : {changed, shorter}) {
    const Result<BatchPlan> read = plan_from_text(each, "night.jsonl");
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().kind, ErrorKind::kBadData);
    EXPECT_THAT(read.error().message(),
                testing::HasSubstr("night.jsonl: it was changed since it was written"));
  }
}

TEST(BatchPlan, OfAnotherVersionIsRefusedByName) {
  BatchPlan plan = sample_plan(1);
  std::string text = text_of(plan);
  text.replace(text.find("weft.batch/1"), 12, "weft.batch/2");
  const Result<BatchHeader> header = header_from_line(text.substr(0, text.find('\n')), "plan");
  ASSERT_FALSE(header);
  EXPECT_EQ(header.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(header.error().message(),
              testing::HasSubstr("its schema is \"weft.batch/2\"; this program reads weft.batch/1"));
}

TEST(BatchPlan, ThatIsNoneIsRefusedWhateverItIs) {
  BatchPlan plan = sample_plan(2);
  const std::string text = text_of(plan);
  const std::string line = text.substr(0, text.find('\n'));
  for (const std::string& bad :
       {std::string(), std::string("{"), std::string("[]"), std::string("{\"schema\": 7}"),
        std::string("{\"schema\": \"weft.batch/1\"}")}) {
    EXPECT_FALSE(header_from_line(bad, "plan")) << bad;
    EXPECT_FALSE(plan_from_text(bad, "plan")) << bad;
  }
  // Every field is missed, and none may be of another kind.
  const Json json = Json::parse(line);
  for (const auto& [key, value] : json.items()) {
    Json without = json, other = json;
    without.erase(key);
    other[key] = value.is_string() ? Json(7) : Json("text");
    EXPECT_FALSE(header_from_line(without.dump(), "plan")) << key;
    EXPECT_FALSE(header_from_line(other.dump(), "plan")) << key;
  }
}

TEST(BatchPlan, OfTenThousandTasksHasAHeaderOfLessThanAMegabyte) {
  BatchPlan plan = sample_plan(0);
  for (int i = 0; i < 10'000; ++i) plan.solves.push_back(sample_solve(i, 600));
  share_out(plan.solves, 600);
  const std::string text = text_of(plan);
  ASSERT_EQ(plan.header.tasks.size(), 10'000U);
  EXPECT_LT(text.find('\n'), 1'000'000U);
}

TEST(SessionDigest, DependsOnWhatASolveDependsOn) {
  const Json session = {{"schema", "weft.session/1.4"},
                        {"fabric", "twill"},
                        {"rig", "a"},
                        {"shots", {{{"led", 1}, {"sha256", "aa"}}}},
                        {"left_out", Json::array()}};
  const std::string digest = digest_of_session(session);
  EXPECT_EQ(digest.size(), 64U);
  Json said = session;
  said["fabric"] = "serge";
  said["metadata"] = {{"tags", {"red"}}};
  said["current_solve"] = "0123";
  said["copy"] = {{"to", "/copies"}};
  EXPECT_EQ(digest_of_session(said), digest) << "what people say of a cloth changes no solve";
  Json other = session;
  other["left_out"] = {3};
  EXPECT_NE(digest_of_session(other), digest);
  other = session;
  other["shots"][0]["sha256"] = "ab";
  EXPECT_NE(digest_of_session(other), digest);
}

TEST(SolveParent, IsInTheSessionOrMirrorsTheArchive) {
  BatchHeader header;
  header.archive = "/archive";
  EXPECT_EQ(solve_parent(header, "/archive/2025/a.weft"), "/archive/2025/a.weft/solve");
  header.output = "/results";
  EXPECT_EQ(solve_parent(header, "/archive/2025/a.weft"), "/results/2025/a.weft/solve");
  EXPECT_EQ(solve_parent(header, "/archive/2024/a.weft"), "/results/2024/a.weft/solve")
      << "one name, two folders";
  EXPECT_EQ(solve_parent(header, "/elsewhere/a.weft"), "/results/elsewhere/a.weft/solve");
}

}  // namespace
}  // namespace weft::library
