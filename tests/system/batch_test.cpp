// SPDX-License-Identifier: Apache-2.0
// Archives: planned, run, killed, run again, and what is said of them.
#include "tests/system/batch_test.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <random>
#include <thread>

#include "capture/raw/decode_raw.h"
#include "core/base/files.h"
#include "core/base/partial_name.h"
#include "core/base/process.h"
#include "core/image_io/image_io.h"
#include "core/rig/session.h"
#include "core/solve/solve.h"
#include "library/catalogue/session_files.h"
#include "simulator/camera/dng_writer.h"
#include "solve/session/current.h"
#include "tests/core/places.h"
#include "tests/system/samples.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

// A run of the plan in a process of its own.
std::unique_ptr<ChildProcess> begin_run(const fs::path& plan, const fs::path& log) {
  auto started =
      ChildProcess::start({program_path("weft"), "batch", "run", plan.string(), "--threads", "1"}, {}, log);
  EXPECT_TRUE(started);
  return std::move(*started);
}

TEST_F(BatchTest, AListIsPlannedAndARunThatMergesEndsAsMergeDoes) {
  fill_archive(2);
  std::ofstream(work_ / "list.txt") << session(0).string() << "\n" << session(1).string() << "\n";
  const Outcome planned = run_weft({"batch", "plan", "--list", (work_ / "list.txt").string(), "--quality",
                                    "fast", "--sample", "0", "-o", plan_file().string(), "--json", "-q"});
  ASSERT_EQ(planned.exit_code, 0) << planned.error;
  EXPECT_EQ(planned.json()["sessions"], 2);
  fs::remove_all(session(1));
  const Outcome outcome = run({"--merge"});
  EXPECT_EQ(outcome.exit_code, 2) << "one failed, and the report says so: " << outcome.error;
  EXPECT_EQ(outcome.json()["report"]["failed"], 1);
  EXPECT_TRUE(fs::exists(fs::path(outcome.json()["report"]["folder"].get<std::string>()) / "report.html"));
  EXPECT_EQ(run_weft({"batch", "plan", "--list", (work_ / "none.txt").string(), "-q"}).exit_code, 66);
}

TEST_F(BatchTest, ARunSolvesWhatIsPlannedOnceAndAsWeftSolveDoes) {
  fill_archive(3);
  const Json planned = plan({"--task-minutes", "0.001", "--sample", "1"});
  EXPECT_EQ(planned["sessions"], 3);
  EXPECT_EQ(planned["tasks"], 3) << "a task has one session at least";
  EXPECT_EQ(planned["sampled"], 1);
  ASSERT_EQ(planned["levels"].size(), 1U) << "no other level than that which is asked for is measured";
  EXPECT_EQ(planned["levels"][0]["quality"], "standard");
  EXPECT_EQ(planned["levels"][0]["solved"], 1) << "degrees stand beside the share that they hold for";
  const Outcome outcome = run();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_EQ(outcome.json()["solved"], 3);
  EXPECT_THAT(outcome.error, HasSubstr("cloth-0: solved in "));

  ASSERT_EQ(run_weft({"solve", session(1).string(), "-q", "-o", (work_ / "alone").string()}).exit_code, 0);
  ASSERT_THAT(solves_of(session(1)), SizeIs(1));
  for (const char* map : kMaps)
    EXPECT_EQ(bytes_of(session(1) / "solve" / solves_of(session(1)).front() / map),
              bytes_of(work_ / "alone" / map))
        << map;

  const Json solve =
      Json::parse(bytes_of(session(1) / "solve" / solves_of(session(1)).front() / "solve.json"));
  EXPECT_GT(solve.at("foretold").at("seconds").get<double>(), 0) << solve;
  EXPECT_GT(solve.at("taken").at("seconds").get<double>(), 0) << solve;

  const auto before = contents_of(archive());
  const Outcome again = run();
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.json()["kept"], 3);
  EXPECT_EQ(again.json()["solved"], 0);
  EXPECT_EQ(contents_of(archive()), before);

  const Outcome merged = merge();
  EXPECT_EQ(merged.exit_code, 0) << merged.error;
  const Json report = merged.json();
  EXPECT_EQ(report["solved"], 3);
  EXPECT_GT(report["predicted_seconds"].get<double>(), 0);
  EXPECT_DOUBLE_EQ(report["seconds_ratio"].get<double>(),
                   report["predicted_seconds"].get<double>() / report["seconds"].get<double>());
  EXPECT_EQ(report["mean_solved"], 1);
  EXPECT_EQ(report["barely_solved"], Json::array());
  EXPECT_GT(fs::file_size(work_ / "night.results" / "report" / "report.html"), 1000U);
}

TEST_F(BatchTest, AFrameThatLiesStandsOnTheFirstPageWithItsCostAndWhatWasDone) {
  fill_archive(2);
  edit_json(session(1) / "session.json", [&](Json& s) {
    const fs::path third = session(1) / s["shots"][2]["file"].get<std::string>();
    const fs::path seventh = session(1) / s["shots"][6]["file"].get<std::string>();
    Result<RawFrame> frame = capture::decode_raw(seventh);
    ASSERT_TRUE(frame) << frame.error().message();
    ++frame->counts(0, 0);  // a file of its own
    ASSERT_TRUE(simulator::write_dng(third, *frame));
    s["shots"][2]["sha256"] = *sha256_of_file(third);
  });
  plan();
  ASSERT_EQ(run().exit_code, 0);
  ASSERT_EQ(merge().exit_code, 0);
  const std::string page = bytes_of(work_ / "night.results" / "report" / "report.html");
  const std::size_t section = page.find("Frames that lie");
  ASSERT_NE(section, page.npos);
  const std::string told = page.substr(section, 1500);
  EXPECT_THAT(told, HasSubstr("cloth-1"));
  EXPECT_THAT(told, testing::ContainsRegex("LED 3[^<]* turns the normals by [0-9.]+[^<]*left out"));
  EXPECT_THAT(told, testing::Not(HasSubstr("cloth-0"))) << "it has no such frame";
}

TEST_F(BatchTest, ATaskSolvesItsOwnSessionsAlone) {
  fill_archive(2);
  plan({"--task-minutes", "0.001", "--sample", "1"});
  const Outcome outcome = run({"--task", "1", "-q"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_THAT(solves_of(session(0)), IsEmpty());
  EXPECT_THAT(solves_of(session(1)), SizeIs(1));
  const Outcome merged = merge();
  EXPECT_EQ(merged.exit_code, 2) << "it is not whole";
  EXPECT_EQ(merged.json()["missing_tasks"], Json({0}));
  const Outcome status = run_weft({"batch", "status", plan_file().string()});
  EXPECT_EQ(status.exit_code, 2);
  EXPECT_THAT(status.output, HasSubstr("tasks to be run: 0"));
  const Outcome commands = run_weft({"batch", "commands", plan_file().string(), "--missing"});
  EXPECT_THAT(commands.output, HasSubstr("batch run " + plan_file().string() + " --task 0 -q\n"));
  EXPECT_EQ(run({"--task", "2", "-q"}).exit_code, 64);
}

TEST_F(BatchTest, KilledAtRandomMomentsItEndsWithOneSolveASession) {
  constexpr int kSessions = 3;
  fill_archive(kSessions);
  plan();
  std::mt19937 random(20261126);
  int kills = 0;
  for (bool is_whole = false; !is_whole && kills < 40;) {
    const auto child = begin_run(plan_file(), work_ / "log");
    // Up to a fifth longer each time, to two minutes, so that a machine that is slow gets there too.
    std::uniform_real_distribution<double> wait_s(0.02, 0.1 * std::pow(1.2, kills));
    const std::optional<int> code = child->wait(wait_s(random));
    is_whole = code == 0;
    if (code) continue;
    child->signal(SIGKILL);
    child->wait(5);
    ++kills;
  }
  ASSERT_LT(kills, 40) << bytes_of(work_ / "log");
  EXPECT_GT(kills, 0) << "nothing was killed";
  Outcome merged = merge();
  // A solve whose run was killed may still be ending.
  for (int i = 0; i < 100 && !half_made().empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    merged = merge();
  }
  EXPECT_EQ(merged.exit_code, 0) << merged.error;
  EXPECT_THAT(half_made(), IsEmpty()) << "merge removes what the dead left";
  for (int i = 0; i < kSessions; ++i) EXPECT_THAT(solves_of(session(i)), SizeIs(1)) << i;
  const Json document = merged.json();
  EXPECT_EQ(document["solved"].get<int>() + document["there"].get<int>(), kSessions);
  EXPECT_EQ(document["failed"], 0) << "a kill is no result";
}

TEST_F(BatchTest, StoppedItEndsOrDropsTheSessionInHandAndAsksToBeRunAgain) {
  fill_archive(4);
  plan();
  const auto child = begin_run(plan_file(), work_ / "log");
  // Into the first sessions: a line a session is written when it ends.
  for (int i = 0; i < 500 && bytes_of(work_ / "log").find("solved in") == std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  child->signal(SIGTERM);
  EXPECT_EQ(child->wait(25), 75) << bytes_of(work_ / "log");
  EXPECT_THAT(half_made(), IsEmpty());
  const Outcome merged = merge();
  EXPECT_EQ(merged.exit_code, 2);
  EXPECT_EQ(merged.json()["failed"], 0);
  EXPECT_GT(merged.json()["missing"], 0);
  EXPECT_EQ(run({"-q"}).exit_code, 0);
  EXPECT_EQ(merge().exit_code, 0);
}

TEST_F(BatchTest, AFailureIsRememberedUntilItIsToBeTriedAgain) {
  fill_archive(3);
  plan();
  const fs::path raw = session(1) / "raw" / "03_led04.dng";
  const std::string good = bytes_of(raw);
  put_bytes(raw, good.substr(0, good.size() - 1000));
  const Outcome outcome = run({"-q"});
  EXPECT_EQ(outcome.exit_code, 65) << outcome.error;
  EXPECT_EQ(outcome.json()["solved"], 2) << "the others are solved all the same";
  EXPECT_THAT(outcome.error, HasSubstr("cloth-1: failed: "));
  EXPECT_THAT(outcome.error, HasSubstr("03_led04.dng"));
  put_bytes(raw, good);
  const Outcome again = run({"-q"});
  EXPECT_EQ(again.exit_code, 65);
  EXPECT_EQ(again.json()["kept_failures"], 1);
  EXPECT_THAT(solves_of(session(1)), IsEmpty());
  EXPECT_EQ(merge().exit_code, 2);
  EXPECT_EQ(report()["causes"].size(), 1U) << report()["causes"];
  const Outcome retried = run({"-q", "--retry-failed"});
  EXPECT_EQ(retried.exit_code, 0) << retried.error;
  EXPECT_THAT(solves_of(session(1)), SizeIs(1));
  EXPECT_EQ(merge().exit_code, 0);
}

TEST_F(BatchTest, ASessionThatWasChangedOrMovedIsRefusedByName) {
  fill_archive(3);
  plan();
  edit_json(session(0) / "session.json", [](Json& json) { json["left_out"] = {1}; });
  edit_json(session(1) / "session.json", [](Json& json) { json["metadata"] = {{"notes", "said since"}}; });
  const Outcome changed = run({"-q"});
  EXPECT_EQ(changed.exit_code, 65);
  EXPECT_THAT(changed.error, HasSubstr("session was changed since the plan: " + session(0).string()));
  EXPECT_EQ(changed.json()["solved"], 2) << "what people say changes no solve";
}

TEST_F(BatchTest, ASessionThatIsGoneIsRefusedByName) {
  fill_archive(1);
  plan();
  fs::rename(session(0), archive() / "other.weft");
  const Outcome moved = run({"-q"});
  EXPECT_EQ(moved.exit_code, 66) << moved.error;
  EXPECT_THAT(moved.error, HasSubstr("session is not where the plan has it: " + session(0).string()));
}

TEST_F(BatchTest, MemoryThatRunsOutCostsTheSessionInHandAlone) {
  fill_archive(2);
  simulate(scene_named("golden", {1600, 1200}), session(7));
  plan();
  const Outcome outcome = run({"-q", "--memory", "100M", "--threads", "1"});
  EXPECT_EQ(outcome.exit_code, 75) << outcome.error;
  EXPECT_EQ(outcome.json()["solved"], 2) << outcome.error;
  EXPECT_EQ(outcome.json()["lost"], 1);
  EXPECT_THAT(outcome.error, HasSubstr("cloth-7: no result: "));
  EXPECT_THAT(half_made(), IsEmpty());
  EXPECT_EQ(merge().json()["failed"], 0);
  EXPECT_EQ(run({"-q"}).exit_code, 0);
}

TEST_F(BatchTest, ADiskThatFillsLosesNothing) {
  fill_archive(2);
  plan();
  const Outcome outcome = run({"-q"}, {.largest_file_bytes = 16'000});
  EXPECT_EQ(outcome.exit_code, 74) << outcome.error;
  EXPECT_THAT(outcome.error, HasSubstr("File too large"));
  EXPECT_THAT(half_made(), IsEmpty());
  const Json merged = merge().json();
  EXPECT_EQ(merged["failed"], 0) << "it says nothing of the sessions";
  EXPECT_EQ(merged["missing"], 2);
  EXPECT_EQ(run({"-q"}).exit_code, 0);
}

TEST_F(BatchTest, TwoPlansOfOneArchiveAtOnceDoNoHarm) {
  fill_archive(3);
  plan();
  const fs::path other = work_ / "other.jsonl";
  ASSERT_EQ(
      run_weft({"batch", "plan", archive().string(), "--sample", "0", "-q", "-o", other.string()}).exit_code,
      0);
  const auto first = begin_run(plan_file(), work_ / "log"), second = begin_run(other, work_ / "log2");
  EXPECT_EQ(first->wait(300), 0) << bytes_of(work_ / "log");
  EXPECT_EQ(second->wait(300), 0) << bytes_of(work_ / "log2");
  for (int i = 0; i < 3; ++i) EXPECT_THAT(solves_of(session(i)), SizeIs(1)) << i;
  EXPECT_THAT(half_made(), IsEmpty());
  EXPECT_EQ(merge().exit_code, 0);
}

TEST_F(BatchTest, WhatIsThereIsLeftOut) {
  fill_archive(2);
  ASSERT_EQ(run_weft({"solve", session(0).string(), "-q"}).exit_code, 0);
  const Json planned = plan();
  EXPECT_EQ(planned["sessions"], 1);
  ASSERT_EQ(planned["left_out"].size(), 1U);
  EXPECT_EQ(planned["left_out"][0]["left_out"], "there");
}

TEST_F(BatchTest, WhatCannotBeSolvedIsNamedWithWhyBeforeAnythingIsSpent) {
  fill_archive(4);
  edit_json(session(0) / "session.json", [](Json& json) { json["state"] = "capturing"; });
  fs::remove(session(1) / "raw" / "03_led04.dng");
  edit_json(session(2) / "session.json", [](Json& json) { json["rig"] = "somebody else's"; });
  const Json planned = plan();
  EXPECT_EQ(planned["sessions"], 1);
  std::string said;
  for (const Json& left : planned["left_out"]) {
    EXPECT_EQ(left["left_out"], "unsolvable");
    said += left["said"].get<std::string>() + "\n";
  }
  EXPECT_THAT(said, HasSubstr("session is not complete"));
  EXPECT_THAT(said, HasSubstr("03_led04.dng"));
  EXPECT_THAT(said, HasSubstr("calibration does not suit the session"));
}

TEST_F(BatchTest, APlanNeverChangesAndOneOfAnotherVersionIsRefused) {
  fill_archive(1);
  plan();
  expect_refusal(work_, {"batch", "plan", archive().string(), "-o", plan_file().string()}, 73,
                 {"a plan never changes", plan_file().string()});
  std::string text = bytes_of(plan_file());
  text.replace(text.find("weft.batch/1"), 12, "weft.batch/2");
  put_bytes(work_ / "newer.jsonl", text);
  for (const char* verb : {"run", "merge", "status", "accept"}) {
    SCOPED_TRACE(verb);
    expect_refusal(work_, {"batch", verb, (work_ / "newer.jsonl").string(), "-q"}, 65,
                   {"weft.batch/2", "weft.batch/1"});
  }
}

TEST_F(BatchTest, AnArchiveThatCannotBeWrittenHasItsSolvesBeside) {
  fill_archive(2);
  const fs::path results = work_ / "solves";
  const auto before = contents_of(archive());
  plan({"--output", results.string(), "--keep", "normal,albedo", "--half", "--compress", "zip"});
  ASSERT_EQ(run({"-q", "--jobs", "2"}).exit_code, 0);
  EXPECT_EQ(contents_of(archive()), before) << "nothing of it is touched";
  for (int i = 0; i < 2; ++i) {
    const std::vector<Product> solves = list_solves(results / session(i).filename());
    ASSERT_THAT(solves, SizeIs(1));
    EXPECT_TRUE(fs::exists(solves[0].folder / "normal.exr"));
    EXPECT_TRUE(fs::exists(solves[0].folder / "albedo.exr"));
    EXPECT_FALSE(fs::exists(solves[0].folder / "sigma.exr"));
    EXPECT_FALSE(fs::exists(solves[0].folder / "status.png"));
    EXPECT_EQ(read_image_info(solves[0].folder / "normal.exr")->type, SampleType::kHalf);
    const Json facts = Json::parse(bytes_of(solves[0].folder / "solve.json"));
    EXPECT_EQ(facts["id"], solves[0].id);
    EXPECT_NE(facts["made_from"], solves[0].id) << "it is not the whole solve, and so has another name";
  }
  EXPECT_EQ(merge().exit_code, 0);
  EXPECT_EQ(run({"-q"}).json()["kept"], 2);
}

TEST_F(BatchTest, SaysWhatChangedAndMovesTheCurrentSolveWhenAsked) {
  fill_archive(2);
  for (int i = 0; i < 2; ++i)
    ASSERT_EQ(run_weft({"solve", session(i).string(), "-q", "--quality", "fast"}).exit_code, 0);
  const std::string old = solves_of(session(0)).front();
  plan();
  const Outcome ran = run();
  ASSERT_EQ(ran.exit_code, 0) << ran.error;
  EXPECT_THAT(ran.error, HasSubstr(", turned by "));
  ASSERT_EQ(merge().exit_code, 0);
  const Json document = report();
  ASSERT_EQ(document["changed"].size(), 2U);
  EXPECT_EQ(document["pictures"].size(), 2U);
  const Json& row = document["sessions"][0];
  const Outcome compared =
      run_weft({"compare", row["folder"], (session(0) / "solve" / old).string(), "--json"});
  ASSERT_EQ(compared.exit_code, 0) << compared.error;
  Json change = compared.json();
  change.erase("regressions");
  EXPECT_EQ(change, row["change"]) << "weft compare of two solves says the same of one";
  const Outcome normals = run_weft({"compare", row["folder"].get<std::string>() + "/normal.exr",
                                    (session(0) / "solve" / old / "normal.exr").string(), "--json"});
  EXPECT_EQ(normals.json()["mean_deg"], row["change"]["mean_deg"]);
  EXPECT_EQ(normals.json()["p95_deg"], row["change"]["p95_deg"]);

  const auto current = [&](int i) {
    return Json::parse(bytes_of(session(i) / "session.json")).value("current_solve", Json());
  };
  EXPECT_TRUE(current(0).is_null()) << "nothing is replaced by itself";
  const auto used = [&](int i) { return solve::current_solve(*read_session(session(i))); };
  EXPECT_EQ(used(0), old) << "it waits until it is accepted, though it is of a higher level";
  ASSERT_EQ(run_weft({"solve", session(1).string(), "-q"}).exit_code, 0);
  EXPECT_EQ(used(1), document["sessions"][1]["solve"]) << "or until a person asks for it";
  const Outcome accepted = run_weft({"batch", "accept", plan_file().string(), "--with-worse", "--json"});
  ASSERT_EQ(accepted.exit_code, 0) << accepted.error;
  EXPECT_EQ(accepted.json()["moved"], 2);
  EXPECT_EQ(current(0), row["solve"]);
  EXPECT_EQ(used(0), row["solve"]);
  EXPECT_THAT(solves_of(session(0)), SizeIs(2));
  ASSERT_EQ(run_weft({"batch", "prune", plan_file().string(), "--keep", "0"}).exit_code, 0);
  EXPECT_THAT(solves_of(session(0)), SizeIs(2)) << "without --yes nothing goes";
  ASSERT_EQ(run_weft({"batch", "prune", plan_file().string(), "--keep", "0", "--yes"}).exit_code, 0);
  EXPECT_THAT(solves_of(session(0)), testing::ElementsAre(row["solve"].get<std::string>()));
  EXPECT_EQ(run({"-q"}).json()["kept"], 2) << "an accepted batch is still done";
}

TEST_F(BatchTest, LeavesOutSessionsWhoseMapsWouldTurnByLittle) {
  fill_archive(2);
  for (int i = 0; i < 2; ++i)
    ASSERT_EQ(run_weft({"solve", session(i).string(), "-q", "--quality", "fast"}).exit_code, 0);
  const Json planned = plan({"--sample", "1", "--least-change", "20"});
  EXPECT_EQ(planned["sessions"], 0);
  ASSERT_EQ(planned["left_out"].size(), 2U);
  EXPECT_EQ(planned["left_out"][0]["left_out"], "turns_little");
  EXPECT_THAT(planned["left_out"][0]["said"].get<std::string>(), HasSubstr("its maps would turn by "));
  EXPECT_EQ(run({"-q"}).exit_code, 0) << "there is nothing to do";
  EXPECT_EQ(merge().exit_code, 0);
}

TEST_F(BatchTest, SpendsHoursWhereTheyBuyMostDegrees) {
  fill_archive(2);
  const Json planned = plan({"--within", "1h", "--sample", "1"});
  ASSERT_GT(planned["curve"].size(), 1U);
  EXPECT_GT(planned["curve"].front()["mean_deg"], planned["curve"].back()["mean_deg"]);
  EXPECT_LE(planned["hours"], 1.0);
  EXPECT_NEAR(planned["mean_deg"].get<double>(), planned["curve"].back()["mean_deg"].get<double>(), 1e-9)
      << "an hour is enough for the best of two small sessions";
  expect_refusal(work_,
                 {"batch", "plan", archive().string(), "-q", "--sample", "1", "--within", "0.001s", "-o",
                  (work_ / "none.jsonl").string()},
                 64, {"there is not that little to do", "allow more hours"});
}

TEST_F(BatchTest, BringsSessionsHereAndTakesSolvesAway) {
  fill_archive(2);
  plan();
  const auto before = contents_of(archive());
  const fs::path far = work_ / "far";
  const std::string script = work_ / "put.sh";
  put_bytes(script,
            fmt::format("set -e\nto={}/$(basename \"$(dirname \"$(dirname \"$2\")\")\")\nmkdir -p \"$to\"\n"
                        "echo \"$2\" >> {}/order\ncp -r \"$1\" \"$to\"\n",
                        far.string(), work_.path().string()));
  const fs::path of_the_dead =
      work_ / "scratch" / fmt::format(".weft-batch-1.{}.99999999.partial", machine_name());
  fs::create_directories(of_the_dead / "0");
  const Outcome outcome = run({"-q", "--fetch", "cp -r {src} {dst}", "--store",
                               "sh " + script + " {src} {dst}", "--scratch", (work_ / "scratch").string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_EQ(contents_of(archive()), before);
  EXPECT_TRUE(fs::is_empty(work_ / "scratch"));
  std::istringstream order(bytes_of(work_ / "order"));
  std::string first, second;
  std::getline(order, first);
  std::getline(order, second);
  EXPECT_EQ(second, first + "/solve.json") << "readers believe solve.json, which goes last";
  EXPECT_EQ(run({"-q", "--fetch", "false", "--store", "false"}).json()["kept"], 2);
  EXPECT_EQ(merge().exit_code, 0);
  expect_refusal(work_, {"batch", "run", plan_file().string(), "--fetch", "true"}, 64,
                 {"solves would lie in scratch"});
}

TEST_F(BatchTest, ReadsSessionsFromStandardInput) {
  fill_archive(3);
  put_bytes(work_ / "list",
            "  Affected sessions\n  " + session(2).string() + "   2026-01-31T10:00:00Z  yes\n");
  auto shell = ChildProcess::start({"/bin/sh", "-c",
                                    fmt::format("{} batch plan - --sample 0 -o {} < {}", program_path("weft"),
                                                plan_file().string(), (work_ / "list").string())},
                                   {}, work_ / "log");
  ASSERT_TRUE(shell);
  ASSERT_EQ((*shell)->wait(300), 0) << bytes_of(work_ / "log");
  ASSERT_EQ(run({"-q"}).exit_code, 0);
  EXPECT_THAT(solves_of(session(0)), IsEmpty());
  EXPECT_THAT(solves_of(session(2)), SizeIs(1));
}

TEST_F(BatchTest, MapsAndExportsOfEachSolveAreInThePriceAndMade) {
  fill_archive(2);
  const auto before = contents_of(archive());
  const Json bare = plan({"--sample", "1"});
  fs::remove(plan_file());
  const Json planned = plan({"--sample", "1", "--then", "maps,export:png16"});
  EXPECT_EQ(contents_of(archive()), before) << "what was tried is gone";
  const double more_s = 3600 * (planned["hours"].get<double>() - bare["hours"].get<double>());
  EXPECT_GT(more_s, 0.2) << "maps take longer than a small cloth's solve";

  const Outcome outcome = run({"-q"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  double made_gb = 0;
  for (const int i : {0, 1}) {
    ASSERT_TRUE(fs::exists(session(i) / "export" / "png16"));
    for (const char* folder : {"rectified", "maps", "export"})
      made_gb += 1e-9 * static_cast<double>(library::bytes_below(session(i) / folder));
  }
  const double foreseen_gb = planned["write_gb"].get<double>() - bare["write_gb"].get<double>();
  EXPECT_NEAR(foreseen_gb, made_gb, 0.1 * made_gb);
}

TEST_F(BatchTest, AnExportThatCannotBeMadeIsSaidBeforeTheNight) {
  fill_archive(1);
  const auto planned = [&](const char* then) {
    return run_weft({"batch", "plan", archive().string(), "--then", then, "-o", plan_file().string(), "-q"});
  };
  const Outcome unknown = planned("export:nonsuch");
  EXPECT_EQ(unknown.exit_code, 66);
  EXPECT_THAT(unknown.error, HasSubstr("there is no such preset: nonsuch"));
  const Outcome preview = run_weft({"batch", "plan", archive().string(), "--then", "maps", "--quality",
                                    "preview", "-o", plan_file().string(), "-q"});
  EXPECT_EQ(preview.exit_code, 64);
  EXPECT_THAT(preview.error, HasSubstr("--quality standard"));
  const Outcome lacking = planned("export:unreal");
  EXPECT_EQ(lacking.exit_code, 65);
  EXPECT_THAT(lacking.error, HasSubstr("occlusion comes from the map occlusion, which these maps lack"));
  EXPECT_FALSE(fs::exists(plan_file()));
}

}  // namespace
}  // namespace weft::test
