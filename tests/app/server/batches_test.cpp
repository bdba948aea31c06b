// SPDX-License-Identifier: Apache-2.0
// Batches over HTTP: asked for, looked at, accepted and forgotten. Their solves are in tests/web/page.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include "app/server/api/bodies/batch_place.h"
#include "core/base/files.h"
#include "core/solve/solve.h"
#include "library/run/plan_file.h"
#include "tests/app/server/raw_client.h"
#include "tests/app/server/scripted_rig.h"
#include "tests/library/batch/sample_plan.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kBatches = "/api/v1/batches";
constexpr const char* kJobs = "/api/v1/jobs";

// A daemon, and the batch "night" of three sessions: one became worse, one failed, one is missing; a fourth
// is left out.
class Batches : public testing::Test {
 protected:
  void SetUp() override {
    server_ = scripted_.started();
    port_ = server_->port();
    ASSERT_TRUE(begin_batch(places(), "night", {"/archive/a.weft"}));
    library::BatchPlan plan = library::sample_plan(3);
    for (library::PlannedSolve& planned : plan.solves)
      planned.session = (scripted_.rig.scan.sessions / fs::path(planned.session).filename()).string();
    plan.header.solver_version = kSolverVersion;
    plan.left_out.push_back({"/archive/torn.weft", library::SkipReason::kUnsolvable, "bad_data",
                             "session cannot be read: it is torn", 0});
    plan.header.curve = {{1, 0.9}, {2, 0.7}};
    solves_ = plan.solves;
    ASSERT_TRUE(library::write_plan(plan_of_batch(places(), "night"), library::text_of(plan)));
    const Result<library::PlanFile> file = library::open_plan(plan_of_batch(places(), "night"));
    ASSERT_TRUE(file) << file.error().message();
    fs::create_directories(file->results());
    write_results(*file);
  }

  void write_results(const library::PlanFile& file) const {
    library::TaskOutcome worse;
    worse.plan = file.header.id;
    worse.session = solves_[0].session;
    worse.state = library::TaskState::kSolved;
    worse.solve = solves_[0].solve;
    worse.folder = (fs::path(solves_[0].session) / "solve" / worse.solve).string();
    worse.change = library::MapChange{};
    worse.change->pixels = 100;
    worse.change->mean_deg = 3.5;
    worse.change->max_deg = 9;
    worse.change->sigma_deg = library::BeforeAfter{0.5, 0.9};
    fs::create_directories(worse.folder);
    ASSERT_TRUE(write_file(fs::path(worse.folder) / kSolveProduct.document, "{}"));
    library::TaskOutcome failed;
    failed.plan = file.header.id;
    failed.session = solves_[1].session;
    failed.state = library::TaskState::kFailed;
    failed.error =
        Error{ErrorKind::kBadData, "frame is truncated", "raw/3.nef", "it ends early", "copy it again"};
    for (const library::TaskOutcome& each : {worse, failed})
      ASSERT_TRUE(library::add_outcome(
          file, each.session == solves_[0].session ? solves_[0].task : solves_[1].task, each));
  }

  fs::path places() const { return scripted_.rig.daemon.state / kBatchFolder; }
  Answer get(const std::string& below) const { return ask(port_, "GET", kBatches + below); }
  Answer post(const std::string& path, const std::string& body) const {
    return ask(port_, "POST", path, body);
  }
  Json ended(const std::string& id) const {
    Json job;
    for (int i = 0; i < 2000; ++i) {
      job = ask(port_, "GET", std::string(kJobs) + "/" + id).json();
      if (job["ended"] != "") return job;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ADD_FAILURE() << job;
    return job;
  }

  ScriptedRig scripted_{"batches"};
  std::unique_ptr<RigServer> server_;
  int port_ = 0;
  std::vector<library::PlannedSolve> solves_;
};

TEST_F(Batches, AreListedWithWhatTheyCost) {
  const Json listed = get("").json()["batches"];
  ASSERT_EQ(listed.size(), 1U) << listed;
  EXPECT_EQ(listed[0]["name"], "night");
  EXPECT_EQ(listed[0]["sessions"], 3);
  EXPECT_EQ(listed[0]["left_out"], 1);
  EXPECT_DOUBLE_EQ(listed[0]["seconds"].get<double>(), 300);
  EXPECT_EQ(listed[0]["is_planned"], true);
  EXPECT_EQ(listed[0]["has_report"], false);
}

TEST_F(Batches, SayWhatIsPlannedWhatIsLeftOutAndHowFarTheyAre) {
  const Json one = get("/night").json();
  EXPECT_EQ(one["done"], (Json{{"solved", 1}, {"failed", 1}, {"missing", 1}}));
  const Json& plan = one["plan"];
  EXPECT_NEAR(plan["mean_deg"].get<double>(), 0.62, 1e-9);
  EXPECT_DOUBLE_EQ(plan["levels"][0]["seconds"].get<double>(), 4500) << "1.25 hours";
  EXPECT_EQ(plan["curve"].size(), 2U);
  EXPECT_DOUBLE_EQ(plan["curve"][1]["seconds"].get<double>(), 7200);
  EXPECT_EQ(plan["reasons"], (Json::array({{{"reason", "unsolvable"}, {"sessions", 1}, {"seconds", 0.0}}})));
  EXPECT_EQ(plan["left_out_sessions"][0]["session"], "torn");
  EXPECT_THAT(plan["left_out_sessions"][0]["said"].get<std::string>(), HasSubstr("torn"));
  EXPECT_EQ(plan["jobs"].size(), 3U);
}

TEST_F(Batches, ReportRegressionsAndCauses) {
  const Json report = get("/night/report").json();
  EXPECT_EQ(report["worse"], 1);
  ASSERT_EQ(report["changes"].size(), 1U) << report;
  EXPECT_EQ(report["changes"][0]["session"], "cloth-0");
  EXPECT_DOUBLE_EQ(report["changes"][0]["change"]["mean_deg"].get<double>(), 3.5);
  EXPECT_THAT(report["changes"][0]["regressions"][0].get<std::string>(), HasSubstr("sigma"));
  EXPECT_EQ(report["changes"][0]["picture"], Json()) << "nobody has merged";
  EXPECT_EQ(report["causes"].size(), 2U) << "of the failed and of the missing one";
  EXPECT_FALSE(report["verdicts"].empty());
  EXPECT_FALSE(report.contains("sessions")) << "all rows are in report.json";
}

TEST_F(Batches, ServeTheReportsFilesAndNoOthers) {
  EXPECT_EQ(get("/night/files/report.html").status, 404) << "it is not written";
  const fs::path report = report_of_batch(places(), "night");
  fs::create_directories(report);
  ASSERT_TRUE(write_file(report / "report.html", "<h1>Batch</h1>"));
  ASSERT_TRUE(write_file(report / "worst-01.png", "\x89PNG"));
  ASSERT_TRUE(write_file(
      report / "report.json",
      Json{{"schema", "weft.batch-report/1.1"},
           {"pictures", Json::array({{{"session", solves_[0].session}, {"file", "worst-01.png"}}})}}
          .dump()));
  const Answer page = get("/night/files/report.html");
  EXPECT_EQ(page.status, 200);
  EXPECT_THAT(page.head, HasSubstr("default-src 'none'"));
  EXPECT_EQ(get("/night/files/worst-01.png").status, 200);
  EXPECT_EQ(get("/night/report").json()["changes"][0]["picture"], "worst-01.png");
  for (const char* other :
       {"/night/files/..%2fplan.jsonl", "/night/files/worst-..png", "/night/files/sessions.txt",
        "/..%2fnight/files/report.html", "/none/files/report.html"})
    EXPECT_EQ(get(other).status, 404) << other;
}

TEST_F(Batches, OfAnotherVersionOrDamagedAreSaidToBe) {
  ASSERT_TRUE(begin_batch(places(), "odd", {"/archive/a.weft"}));
  ASSERT_TRUE(write_file(plan_of_batch(places(), "odd"), R"({"schema": "weft.batch/9"})"));
  const Json listed = get("").json()["batches"];
  ASSERT_EQ(listed.size(), 2U);
  const Json& odd = listed[0]["name"] == "odd" ? listed[0] : listed[1];
  EXPECT_NE(odd["fault"], "") << odd;
  EXPECT_EQ(get("/odd").status, 422);
  EXPECT_EQ(get("/odd/report").status, 422);
  EXPECT_EQ(post(kJobs, R"({"kind": "batch_run", "batch": "odd"})").status, 422);
  EXPECT_EQ(post(std::string(kBatches) + "/odd/accept", "{}").status, 422);
}

TEST_F(Batches, OfAnArchiveAreAnsweredInShort) {
  constexpr int kMany = 10000;
  library::BatchPlan plan = library::sample_plan(kMany);
  for (int i = 0; i < kMany; ++i)
    plan.left_out.push_back(
        {"/archive/there.weft", library::SkipReason::kThere, "", "its solve is there", 1});
  ASSERT_TRUE(begin_batch(places(), "large", {"/archive/a.weft"}));
  ASSERT_TRUE(library::write_plan(plan_of_batch(places(), "large"), library::text_of(plan)));
  for (const char* path : {"", "/large", "/large/report"}) {
    const auto began = std::chrono::steady_clock::now();
    const Answer answer = get(path);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
    ASSERT_EQ(answer.status, 200) << path;
    EXPECT_LT(answer.body.size(), 200'000U) << path;
    EXPECT_LT(took.count(), 20) << path;
    RecordProperty(fmt::format("ms{}", path), static_cast<int>(1000 * took.count()));
  }
  const Json one = get("/large").json();
  EXPECT_EQ(one["plan"]["jobs"].size(), 200U);
  EXPECT_EQ(one["plan"]["reasons"][0]["sessions"], kMany);
  EXPECT_EQ(one["done"]["missing"], kMany);
}

TEST_F(Batches, WithoutAPlanWaitForTheirJob) {
  ASSERT_TRUE(begin_batch(places(), "early", {"/archive/a.weft"}));
  const Json one = get("/early").json();
  EXPECT_EQ(one["plan"], Json());
  EXPECT_EQ(one["batch"]["is_planned"], false);
  EXPECT_EQ(one["batch"]["fault"], "");
  EXPECT_EQ(get("/early/report").status, 404);
  EXPECT_EQ(post(kJobs, R"({"kind": "batch_run", "batch": "early"})").status, 404);
}

TEST_F(Batches, AcceptWhatIsAskedForAndSayWhatStays) {
  const std::string accept = std::string(kBatches) + "/night/accept";
  const Answer tried = post(accept, R"({"dry_run": true})");
  ASSERT_EQ(tried.status, 200) << tried.body;
  EXPECT_EQ(tried.json()["moved"], 0);
  EXPECT_EQ(tried.json()["left"], 3);
  EXPECT_THAT(tried.json()["left_sessions"][0]["why"].get<std::string>(), HasSubstr("it became worse"));
  for (const char* wrong :
       {R"({"dry_run": 1})", R"({"sessions": []})", R"({"sessions": "all"})", R"({"all": true})"})
    EXPECT_EQ(post(accept, wrong).status, 400) << wrong;
  EXPECT_EQ(post(accept, R"({"sessions": ["nobody"]})").status, 400);
  EXPECT_EQ(post(std::string(kBatches) + "/none/accept", "{}").status, 404);
}

TEST_F(Batches, AreForgottenOnceTheirJobHasEnded) {
  const Answer gone = ask(port_, "DELETE", std::string(kBatches) + "/night");
  EXPECT_EQ(gone.status, 200) << gone.body;
  EXPECT_FALSE(fs::exists(places() / "night"));
  EXPECT_EQ(ask(port_, "DELETE", std::string(kBatches) + "/night").status, 404);
}

TEST_F(Batches, ThatArePlannedTwiceByOneRequestAreOne) {
  scripted_.leave_unfinished("left");
  const std::string body =
      R"({"kind": "batch_plan", "sessions": ["left"], "quality": "fast", "sample": 0, "request_id": "a"})";
  const Answer first = post(kJobs, body);
  ASSERT_EQ(first.status, 202) << first.body;
  EXPECT_EQ(first.json()["of"], "0001");
  EXPECT_EQ(first.json()["wants"]["sessions"], 1);
  EXPECT_EQ(post(kJobs, body).json()["id"], first.json()["id"]);
  EXPECT_FALSE(fs::exists(places() / "0002"));
  ended(first.json()["id"]);
}

}  // namespace
}  // namespace weft::app
